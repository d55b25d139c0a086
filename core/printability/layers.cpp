#include "core/printability/layers.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/edge_table.h"
#include "core/printability/printability.h"

namespace fretwork {
namespace {

/// Loops are led through points where edges cross the plane; this far off they may be left out.
constexpr double kCleanMm = 0.002;
constexpr std::size_t kMostLayers = 100'000;

/// Cuts one mesh at any number of heights.
class Cutter {
  public:
    Cutter(const TriangleMesh& mesh, const RunControl& run) : mesh_(mesh), edge_of_(3 * mesh.triangles.size()) {
        const EdgeTable edges(mesh, run);
        for (std::size_t e = 0; e < edges.size(); ++e)
            for (const HalfEdge h : edges.half_edges(e)) edge_of_[h] = static_cast<std::uint32_t>(e);
    }

    /// \param triangles  at least those that reach across the height
    [[nodiscard]] Polygons cut(double z, const std::vector<std::uint32_t>& triangles) const {
        std::vector<Step> steps;
        for (const std::uint32_t t : triangles)
            if (const std::optional<Step> step = step_through(t, z)) steps.push_back(*step);
        std::ranges::sort(steps, {}, &Step::order);
        return solid_of(cleaned(loops(steps), kCleanMm));
    }

  private:
    /// A triangle leads the border from the edge where it dips below the plane to the one where it rises, with the
    /// material on the left.
    struct Step {
        std::uint32_t from_edge, to_edge, triangle;
        ClipperLib::IntPoint start;
        [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> order() const { return {from_edge, triangle}; }
    };

    [[nodiscard]] bool above(std::uint32_t v, double z) const { return mesh_.positions_mm[v][2] >= z; }

    [[nodiscard]] std::optional<Step> step_through(std::uint32_t t, double z) const {
        const Triangle& corners = mesh_.triangles[t];
        std::optional<std::uint32_t> down, up;
        for (std::uint32_t k = 0; k < 3; ++k) {
            const bool start = above(corners[k], z), end = above(corners[(k + 1) % 3], z);
            if (start && !end) down = k;
            if (!start && end) up = k;
        }
        if (!down || !up) return std::nullopt;
        return Step{edge_of_[3 * t + *down], edge_of_[3 * t + *up], t,
                    crossing(corners[*down], corners[(*down + 1) % 3], z)};
    }

    /// From the lower to the higher index, so that both triangles of an edge find the same point.
    [[nodiscard]] ClipperLib::IntPoint crossing(std::uint32_t a, std::uint32_t b, double z) const {
        const Vec3 &p = mesh_.positions_mm[std::min(a, b)], &q = mesh_.positions_mm[std::max(a, b)];
        const double t = (z - p[2]) / (q[2] - p[2]);
        return point_of(Vec2(p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])));
    }

    /// Follows steps from edge to edge; `steps` ascend by their first edge. Loops that do not close are dropped.
    static Polygons loops(const std::vector<Step>& steps) {
        Polygons all;
        std::vector<std::uint8_t> used(steps.size(), 0);
        for (std::size_t first = 0; first < steps.size(); ++first) {
            Polygon loop;
            std::size_t at = first;
            while (at < steps.size() && !used[at]) {
                used[at] = 1;
                loop.push_back(steps[at].start);
                at = unused_from(steps, used, steps[at].to_edge, first);
            }
            if (at == first && loop.size() > 2) all.push_back(std::move(loop));
        }
        return all;
    }

    /// A step that starts on the edge: `first` if it is one, so that a loop closes as soon as it can.
    static std::size_t unused_from(const std::vector<Step>& steps, const std::vector<std::uint8_t>& used,
                                   std::uint32_t edge, std::size_t first) {
        if (steps[first].from_edge == edge) return first;
        const auto found = std::ranges::lower_bound(steps, edge, {}, &Step::from_edge);
        for (auto i = static_cast<std::size_t>(found - steps.begin()); i < steps.size(); ++i) {
            if (steps[i].from_edge != edge) break;
            if (!used[i]) return i;
        }
        return steps.size();
    }

    const TriangleMesh& mesh_;
    std::vector<std::uint32_t> edge_of_;
};

std::pair<double, double> extent_of(const TriangleMesh& mesh, const Triangle& t) {
    const double a = mesh.positions_mm[t[0]][2], b = mesh.positions_mm[t[1]][2], c = mesh.positions_mm[t[2]][2];
    return {std::min({a, b, c}), std::max({a, b, c})};
}

/// Triangles that may reach across each height, ascending.
std::vector<std::vector<std::uint32_t>> triangles_across(const TriangleMesh& mesh,
                                                         const std::vector<double>& heights_mm) {
    std::vector<std::vector<std::uint32_t>> lists(heights_mm.size());
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        const auto [low, high] = extent_of(mesh, mesh.triangles[t]);
        const auto first = std::ranges::lower_bound(heights_mm, low) - heights_mm.begin();
        for (auto i = static_cast<std::size_t>(first); i < heights_mm.size() && heights_mm[i] <= high; ++i)
            lists[i].push_back(t);
    }
    return lists;
}

struct Layering {
    double low_mm = 0.0;
    std::size_t count = 0;
};

/// Layers of one height between the lowest and the highest point.
Layering layering(const TriangleMesh& mesh, double step) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Triangle& t : mesh.triangles) {
        const auto [least, most] = extent_of(mesh, t);
        low = std::min(low, least);
        high = std::max(high, most);
    }
    const double count = std::max(1.0, std::ceil((high - low) / step - 0.5));
    if (count > static_cast<double>(kMostLayers))
        throw InvalidInput("printability: the model is " + std::to_string(high - low) + " mm high, more than " +
                           std::to_string(kMostLayers) + " layers of " + std::to_string(step) + " mm");
    return {low, static_cast<std::size_t>(count)};
}

}  // namespace

std::size_t layer_count(const TriangleMesh& mesh, double layer_height_mm) {
    return layering(mesh, layer_height_mm).count;
}

std::vector<Layer> cut_at(const TriangleMesh& mesh, const std::vector<double>& heights_mm, const RunControl& run) {
    const auto lists = triangles_across(mesh, heights_mm);
    const Cutter cutter(mesh, run);
    std::vector<Layer> layers(heights_mm.size());
    parallel_for(layers.size(), 1, [&](std::size_t i) {
        run.throw_if_stopped();
        layers[i] = {heights_mm[i], cutter.cut(heights_mm[i], lists[i])};
    });
    return layers;
}

std::vector<Layer> cut_layers(const TriangleMesh& mesh, double layer_height_mm, const RunControl& run) {
    const Layering layers = layering(mesh, layer_height_mm);
    std::vector<double> middles_mm;
    for (std::size_t i = 0; i < layers.count; ++i)
        middles_mm.push_back(layers.low_mm + (static_cast<double>(i) + 0.5) * layer_height_mm);
    return cut_at(mesh, middles_mm, run);
}

}  // namespace fretwork
