#include "core/printability/printability.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/check_mesh.h"
#include "core/mesh/components.h"
#include "core/printability/layers.h"
#include "core/printability/supports.h"
#include "core/printability/wall_widths.h"

namespace fretwork {
namespace {

constexpr const char* kStage = "printability";

void need(double value, double low, double high, const char* name) {
    if (value >= low && value <= high) return;
    throw InvalidSetting(std::string("printability: ") + name + " is " + std::to_string(value) + "; expected " +
                         std::to_string(low) + " to " + std::to_string(high));
}

void check(const PrintabilitySettings& settings) {
    constexpr double kLeastMm = 0.01, kMostMm = 100.0;
    need(settings.layer_height_mm, kLeastMm, 10.0, "layer_height_mm");
    need(settings.overhang_deg, 0.0, 89.0, "overhang_deg");
    need(settings.min_feature_mm, kLeastMm, kMostMm, "min_feature_mm");
    need(settings.min_hole_mm, kLeastMm, kMostMm, "min_hole_mm");
}

void keep_longer(const PrintPlace& place, PrintPlace& longest) {
    if (place.size_mm > longest.size_mm) longest = place;
}

void add(const LayerSupports& supports, PrintabilityReport& report) {
    report.islands += supports.islands.size();
    report.islands_per_layer.push_back(supports.islands.size());
    report.island_places.insert(report.island_places.end(), supports.islands.begin(), supports.islands.end());
    report.overhang_area_mm2 += supports.overhang_mm2;
    keep_longer(supports.longest_bridge, report.longest_bridge);
    keep_longer(supports.longest_cantilever, report.longest_cantilever);
}

void look_below_all(const std::vector<Layer>& layers, const PrintabilitySettings& settings, const RunControl& run,
                    PrintabilityReport& report) {
    const double reach = settings.layer_height_mm * std::tan(settings.overhang_deg * std::numbers::pi / 180.0);
    std::vector<LayerSupports> found(layers.size());
    parallel_for(layers.size() - 1, 1, [&](std::size_t i) {
        run.throw_if_stopped();
        found[i + 1] = look_below(layers[i + 1], layers[i], reach);
    });
    for (const LayerSupports& supports : found) add(supports, report);
    std::ranges::stable_sort(report.island_places, std::ranges::greater{}, &PrintPlace::size_mm);
    if (report.island_places.size() > kMostPlaces) report.island_places.resize(kMostPlaces);
}

/// \return the share of the points with less than the limit, and the width that one of 200 falls short of
std::pair<double, std::optional<PrintPlace>> least_of(std::vector<WallWidth> widths, double limit_mm) {
    constexpr std::size_t kOneOf = 200;
    std::ranges::stable_sort(widths, {}, &WallWidth::width_mm);
    const auto below = std::ranges::lower_bound(widths, limit_mm, {}, &WallWidth::width_mm) - widths.begin();
    const WallWidth& least = widths[widths.size() / kOneOf];
    std::optional<PrintPlace> place;
    if (least.width_mm < limit_mm) place = PrintPlace{least.at_mm, least.width_mm};
    return {static_cast<double>(below) / static_cast<double>(widths.size()), place};
}

void measure_widths(const TriangleMesh& mesh, const PrintabilitySettings& settings, const RunControl& run,
                    PrintabilityReport& report) {
    const SurfaceTree tree(mesh, run);
    const auto least = [&](WallSide side, double limit) {
        return least_of(wall_widths(mesh, tree, side, limit, run), limit);
    };
    std::tie(report.thin_share, report.least_solid) = least(WallSide::kMaterial, settings.min_feature_mm);
    std::tie(report.narrow_share, report.least_hole) = least(WallSide::kGap, settings.min_hole_mm);
}

/// Pieces of surface by the sign of what they enclose.
void count_pieces(const TriangleMesh& mesh, std::size_t bodies, const RunControl& run, PrintabilityReport& report) {
    const MeshComponents components = find_components(mesh, ConnectedBy::kEdge, run);
    std::vector<double> volume(components.count, 0.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Triangle& k = mesh.triangles[t];
        const Vec3 &a = mesh.positions_mm[k[0]], &b = mesh.positions_mm[k[1]], &c = mesh.positions_mm[k[2]];
        volume[components.of_triangle[t]] += a.dot(b.cross(c)) / 6.0;
    }
    std::size_t solids = 0;
    for (const double v : volume) {
        report.material_mm3 += v;
        if (v < 0.0)
            ++report.closed_cavities;
        else
            ++solids;
    }
    report.loose_parts = solids > bodies ? solids - bodies : 0;
}

}  // namespace

PrintabilityReport printability(const TriangleMesh& mesh, const PrintabilitySettings& settings, const RunControl& run) {
    check_mesh(mesh, kStage, ZeroArea::kAllowed);
    check(settings);
    PrintabilityReport report;
    report.layer_height_mm = settings.layer_height_mm;
    count_pieces(mesh, settings.bodies, run, report);
    const std::vector<Layer> layers = cut_layers(mesh, settings.layer_height_mm, run);
    run.checkpoint(kStage, 0.2);
    report.layers = layers.size();
    report.first_layer_contact_mm2 = area_mm2(layers.front().outline);
    report.empty_layers = static_cast<std::size_t>(
        std::ranges::count_if(layers, [](const Layer& layer) { return layer.outline.empty(); }));
    look_below_all(layers, settings, run, report);
    run.checkpoint(kStage, 0.7);
    measure_widths(mesh, settings, run, report);
    run.checkpoint(kStage, 1.0);
    return report;
}

}  // namespace fretwork
