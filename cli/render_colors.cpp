#include "cli/render_colors.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <span>

#include "cli/view_colors.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/edge_table.h"

namespace fretwork::cli {
namespace {

const char* property_of(RenderColor color) {
    switch (color) {
        case RenderColor::kStress:
            return "fw:stress";
        case RenderColor::kBridges:
            return "fw:reinforced";
        default:
            return "fw:label";
    }
}

const VolumetricObject& only_object(const VolumetricFile& file, const std::string& source) {
    if (file.objects.size() != 1 || file.mesh.parts.size() > 1)
        throw InvalidInput(fmt::format("{}: found {} objects with voxel data in {} parts, expected a carved 3MF of one",
                                       source, file.objects.size(), file.mesh.parts.size()));
    return file.objects.front();
}

/// Triangles that share an edge, three each; a triangle stands for none at a border.
std::vector<std::array<std::uint32_t, 3>> neighbors(const TriangleMesh& mesh) {
    std::vector<std::array<std::uint32_t, 3>> next(mesh.triangles.size());
    for (std::uint32_t t = 0; t < next.size(); ++t) next[t] = {t, t, t};
    const EdgeTable edges(mesh);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const std::span<const HalfEdge> there = edges.half_edges(e);
        for (std::size_t i = 0; i + 1 < there.size(); ++i) {
            next[there[i] / 3][there[i] % 3] = there[i + 1] / 3;
            next[there[i + 1] / 3][there[i + 1] % 3] = there[i] / 3;
        }
    }
    return next;
}

/// Values at the middles of the triangles; where `known` is not above 0 that of the nearest triangle, counted in steps
/// over edges. Negative where none is near.
std::vector<double> triangle_values(const TriangleMesh& mesh, const VolumetricObject& object, const char* property,
                                    const char* known) {
    std::vector<double> values(mesh.triangles.size(), -1.0);
    parallel_for(values.size(), 1024, [&](std::size_t t) {
        const Triangle& corners = mesh.triangles[t];
        const Vec3 middle =
            (mesh.positions_mm[corners[0]] + mesh.positions_mm[corners[1]] + mesh.positions_mm[corners[2]]) / 3.0;
        if (object.property(known, middle).value_or(1.0) > 0.0) values[t] = *object.property(property, middle);
    });
    const std::vector<std::array<std::uint32_t, 3>> next = neighbors(mesh);
    std::vector<std::uint32_t> front;
    for (std::uint32_t t = 0; t < values.size(); ++t)
        if (values[t] >= 0.0) front.push_back(t);
    for (std::size_t i = 0; i < front.size(); ++i)
        for (const std::uint32_t n : next[front[i]])
            if (values[n] < 0.0) {
                values[n] = values[front[i]];
                front.push_back(n);
            }
    return values;
}

/// Hues by the golden ratio, so that patches with numbers close together look unlike.
Rgb8 label_color(double label) {
    if (label <= 0.0) return kNotKnown;
    const double hue = std::fmod(label * 0.6180339887498949, 1.0);
    Rgb8 color{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double from = std::abs(std::fmod(hue + static_cast<double>(k) / 3.0, 1.0) * 6.0 - 3.0) - 1.0;
        color[k] = static_cast<std::uint8_t>(std::lround(255.0 * (0.35 + 0.5 * std::clamp(from, 0.0, 1.0))));
    }
    return color;
}

}  // namespace

RenderColor render_color_named(const std::string& name) {
    const std::map<std::string, RenderColor> known = {{"pattern", RenderColor::kPattern},
                                                      {"stress", RenderColor::kStress},
                                                      {"bridges", RenderColor::kBridges},
                                                      {"labels", RenderColor::kLabels},
                                                      {"solid", RenderColor::kSolid}};
    const auto found = known.find(name);
    if (found == known.end())
        throw InvalidSetting(fmt::format("--colour {}: expected pattern, stress, bridges, labels or solid", name));
    return found->second;
}

std::vector<Rgb8> render_colors(const VolumetricFile& file, RenderColor color, const std::string& source) {
    const VolumetricObject& object = only_object(file, source);
    const char* property = property_of(color);
    const std::vector<std::string> there = object.properties();
    if (std::ranges::find(there, property) == there.end())
        throw InvalidInput(fmt::format("{}: found no {} in its voxel data, expected it", source, property));
    const std::vector<double> values = triangle_values(file.mesh.mesh, object, property,
                                                       // Labels are everywhere on the shell and nowhere else.
                                                       color == RenderColor::kStress ? "fw:stress" : "fw:label");
    if (color == RenderColor::kStress) return stress_colors(values).colors;
    std::vector<Rgb8> colors;
    for (const double value : values)
        colors.push_back(color == RenderColor::kLabels ? label_color(value) : value > 0.5 ? kBridge : kPlain);
    return colors;
}

StressColors stress_colors(const std::vector<double>& mpa) {
    ShellStress stress;
    stress.after.samples_mpa = {mpa.empty() ? 0.0 : *std::ranges::max_element(mpa)};
    StressColors result{stress_scale(stress), {}};
    for (const double value : mpa)
        result.colors.push_back(value > 0.0 ? stress_color(result.scale.place(value)) : kNotKnown);
    return result;
}

}  // namespace fretwork::cli
