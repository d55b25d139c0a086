#include "core/printability/printability.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/check_mesh.h"
#include "core/mesh/components.h"
#include "core/printability/layers.h"
#include "core/printability/supports.h"
#include "core/printability/widths.h"

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

struct LayerFindings {
    LayerSupports supports;
    std::optional<Neck> thin, narrow;
};

LayerFindings look_at(const std::vector<Layer>& layers, std::size_t i, const PrintabilitySettings& settings) {
    LayerFindings found;
    const double reach = settings.layer_height_mm * std::tan(settings.overhang_deg * std::numbers::pi / 180.0);
    if (i > 0) found.supports = look_below(layers[i], layers[i - 1], reach);
    found.thin = narrowest(layers[i].outline, settings.min_feature_mm);
    found.narrow = narrowest_gap(layers[i].outline, settings.min_hole_mm);
    return found;
}

void keep_longer(const PrintPlace& place, PrintPlace& longest) {
    if (place.size_mm > longest.size_mm) longest = place;
}

void keep_less(const std::optional<Neck>& neck, double z, std::size_t& layers, std::optional<PrintPlace>& least) {
    if (!neck) return;
    ++layers;
    if (!least || neck->width_mm < least->size_mm)
        least = PrintPlace{Vec3(neck->at_mm[0], neck->at_mm[1], z), neck->width_mm};
}

void add(const Layer& layer, const LayerFindings& found, PrintabilityReport& report) {
    const LayerSupports& supports = found.supports;
    report.islands += supports.islands.size();
    report.islands_per_layer.push_back(supports.islands.size());
    report.island_places.insert(report.island_places.end(), supports.islands.begin(), supports.islands.end());
    report.overhang_area_mm2 += supports.overhang_mm2;
    keep_longer(supports.longest_bridge, report.longest_bridge);
    keep_longer(supports.longest_cantilever, report.longest_cantilever);
    keep_less(found.thin, layer.middle_mm, report.thin_layers, report.least_solid);
    keep_less(found.narrow, layer.middle_mm, report.narrow_layers, report.least_hole);
}

/// Pieces of surface by the sign of what they enclose.
void count_pieces(const TriangleMesh& mesh, const RunControl& run, PrintabilityReport& report) {
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
    report.loose_parts = solids > 0 ? solids - 1 : 0;
}

}  // namespace

PrintabilityReport printability(const TriangleMesh& mesh, const PrintabilitySettings& settings, const RunControl& run) {
    check_mesh(mesh, kStage, ZeroArea::kAllowed);
    check(settings);
    PrintabilityReport report;
    report.layer_height_mm = settings.layer_height_mm;
    count_pieces(mesh, run, report);
    const std::vector<Layer> layers = cut_layers(mesh, settings.layer_height_mm, run);
    run.checkpoint(kStage, 0.2);
    std::vector<LayerFindings> found(layers.size());
    parallel_for(layers.size(), 1, [&](std::size_t i) {
        run.throw_if_stopped();
        found[i] = look_at(layers, i, settings);
    });
    report.layers = layers.size();
    report.first_layer_contact_mm2 = area_mm2(layers.front().outline);
    for (std::size_t i = 0; i < layers.size(); ++i) {
        if (layers[i].outline.empty()) ++report.empty_layers;
        add(layers[i], found[i], report);
    }
    std::ranges::stable_sort(report.island_places, std::ranges::greater{}, &PrintPlace::size_mm);
    if (report.island_places.size() > kMostPlaces) report.island_places.resize(kMostPlaces);
    run.checkpoint(kStage, 1.0);
    return report;
}

}  // namespace fretwork
