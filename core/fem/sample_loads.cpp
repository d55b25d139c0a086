#include "core/fem/sample_loads.h"

#include <algorithm>
#include <limits>

#include "core/base/disjoint_sets.h"

namespace fretwork {
namespace {

constexpr double kStandardGravity = 9.81;  // m/s^2

/// Area of the pattern that each sample stands for, mm^2.
std::vector<double> tributary_area_mm2(const SurfaceVoxels& shell, const SolidStates& solid,
                                       const AbstractGraph& graph) {
    std::vector<double> area(graph.samples.size(), 0.0);
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (solid[v] == SolidState::kSolid && graph.owner[v] != kNoSample)
            area[graph.owner[v]] += static_cast<double>(shell.area_mm2[v]);
    return area;
}

void add_self_weight(const std::vector<double>& area_mm2, const LoadCase& load_case, const Material& material,
                     double thickness_mm, std::vector<Vec3>& force_n) {
    const double kg_per_mm2 = thickness_mm * material.density_kg_m3 * 1e-9;
    const Vec3 newton_per_kg = kStandardGravity * load_case.acceleration_g;
    double total = 0.0;
    for (const double area : area_mm2) total += area;
    for (std::size_t s = 0; s < force_n.size(); ++s) {
        const double area = load_case.constant_per_sample ? total / static_cast<double>(force_n.size()) : area_mm2[s];
        force_n[s] += kg_per_mm2 * area * newton_per_kg;
    }
}

void add_patch(const SurfaceVoxels& shell, const AbstractGraph& graph, const PatchLoad& patch,
               std::vector<Vec3>& force_n) {
    const double share = 1.0 / static_cast<double>(std::max<std::size_t>(1, patch.voxels.size()));
    for (const VoxelIndex v : patch.voxels) {
        if (graph.owner[v] == kNoSample) continue;
        force_n[graph.owner[v]] += share * patch.force_n;
        const double pressed = patch.pressure_mpa * static_cast<double>(shell.area_mm2[v]);
        force_n[graph.owner[v]] -= pressed * shell.normals[v].cast<double>();
    }
}

void hold_lowest_tenth(const SurfaceVoxels& shell, const AbstractGraph& graph, const std::vector<SampleIndex>& piece,
                       const std::vector<std::uint8_t>& held, std::vector<std::uint8_t>& fixed) {
    const std::size_t n = graph.samples.size();
    std::vector<double> low(n, std::numeric_limits<double>::infinity());
    std::vector<double> high(n, -std::numeric_limits<double>::infinity());
    for (std::size_t s = 0; s < n; ++s) {
        const double z = shell.points_mm[graph.samples[s]][2];
        low[piece[s]] = std::min(low[piece[s]], z);
        high[piece[s]] = std::max(high[piece[s]], z);
    }
    for (std::size_t s = 0; s < n; ++s) {
        const SampleIndex p = piece[s];
        if (held[p] == 0 && shell.points_mm[graph.samples[s]][2] <= low[p] + 0.1 * (high[p] - low[p])) fixed[s] = 1;
    }
}

std::vector<std::uint8_t> fixed_samples(const SurfaceVoxels& shell, const AbstractGraph& graph,
                                        const std::vector<VoxelIndex>& fixed_voxels) {
    const std::size_t n = graph.samples.size();
    const std::vector<SampleIndex> piece = piece_of_samples(graph);
    std::vector<std::uint8_t> fixed(n, 0);
    std::vector<std::uint8_t> held(n, 0);  // per piece
    for (const VoxelIndex v : fixed_voxels) {
        const auto at = std::ranges::lower_bound(graph.samples, v);
        if (at == graph.samples.end() || *at != v) continue;
        const auto s = static_cast<std::size_t>(at - graph.samples.begin());
        fixed[s] = 1;
        held[piece[s]] = 1;
    }
    const std::vector<std::uint8_t> held_directly = held;
    for (const VoxelIndex v : fixed_voxels) {
        const SampleIndex s = graph.owner[v];
        if (s == kNoSample || held_directly[piece[s]] != 0) continue;
        fixed[s] = 1;
        held[piece[s]] = 1;
    }
    hold_lowest_tenth(shell, graph, piece, held, fixed);
    return fixed;
}

}  // namespace

std::vector<SampleIndex> piece_of_samples(const AbstractGraph& graph) {
    DisjointSets pieces(graph.samples.size());
    for (const AbstractEdge& edge : graph.edges) pieces.unite(edge.a, edge.b);
    std::vector<SampleIndex> piece(graph.samples.size());
    for (SampleIndex s = 0; s < piece.size(); ++s) piece[s] = pieces.find(s);
    return piece;
}

SampleLoads loads_on_samples(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                             const LoadCase& load_case, const Material& material, double thickness_mm) {
    SampleLoads loads;
    loads.force_n.assign(graph.samples.size(), Vec3::Zero());
    add_self_weight(tributary_area_mm2(shell, solid, graph), load_case, material, thickness_mm, loads.force_n);
    for (const PatchLoad& patch : load_case.loads) add_patch(shell, graph, patch, loads.force_n);
    loads.fixed = fixed_samples(shell, graph, load_case.fixed);
    return loads;
}

}  // namespace fretwork
