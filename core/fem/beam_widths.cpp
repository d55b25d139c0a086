#include "core/fem/beam_widths.h"

#include <algorithm>
#include <numbers>
#include <span>
#include <utility>

#include "core/base/parallel.h"
#include "core/graph/pattern_width.h"

namespace fretwork {
namespace {

/// No pattern is taken to be wider than this; the border between regions bounds widths much earlier.
constexpr double kWidestHalfVoxels = 1000.0;

/// A net of bars along the edges of a triangulation of equilateral triangles stretches like the sheet it stands for
/// when each bar has 1.5 times the width of its border: k = E t w / L with w = L / sqrt 3 makes a sheet of 2/3 E.
constexpr double kNetFactor = 1.5;

/// Among equilateral triangles the width is 0.87 of the length.
constexpr double kSliverShare = 0.25;

double harmonic_half_width(std::span<const VoxelIndex> path, const std::vector<float>& half_width) {
    double sum = 0.0;
    for (const VoxelIndex v : path) sum += 1.0 / std::max(0.5, static_cast<double>(half_width[v]));
    return static_cast<double>(path.size()) / sum;
}

/// Length of border that one link across it stands for, seen from each voxel, mm. Cauchy and Crofton: a
/// border of length B at a random angle is crossed by B (2 / pi) S / A links, where A is the area per voxel
/// and S half of the summed lengths of a voxel's links.
std::vector<float> border_per_link_mm(const SurfaceVoxels& shell) {
    std::vector<float> border(shell.size(), 0.0f);
    parallel_for(shell.size(), 4096, [&](std::size_t v) {
        double summed = 0.0;
        for (std::uint32_t e = shell.adjacency.first[v]; e < shell.adjacency.first[v + 1]; ++e)
            summed += static_cast<double>(shell.adjacency.length_voxels[e]);
        if (summed == 0.0) return;
        const double area = static_cast<double>(shell.area_mm2[v]);
        border[v] = static_cast<float>(0.5 * std::numbers::pi * area / (0.5 * summed * shell.grid.voxel_mm));
    });
    return border;
}

/// Length of the border between the regions of each solid edge's samples, mm.
std::vector<double> border_lengths_mm(const SurfaceVoxels& shell, const SolidStates& solid,
                                      const AbstractGraph& graph) {
    const std::vector<float> per_link = border_per_link_mm(shell);
    const auto pair_of = [](const AbstractEdge& edge) { return std::pair(edge.a, edge.b); };
    std::vector<double> border_mm(graph.edges.size(), 0.0);
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        if (solid[v] == SolidState::kEmpty || graph.owner[v] == kNoSample) continue;
        for (const VoxelIndex w : shell.adjacency.of(v)) {
            // Each link is met from both ends; the lower owner takes it.
            if (solid[w] == SolidState::kEmpty || graph.owner[w] == kNoSample || graph.owner[v] >= graph.owner[w])
                continue;
            const std::pair pair(graph.owner[v], graph.owner[w]);
            const auto at = std::ranges::lower_bound(graph.edges, pair, {}, pair_of);
            if (at == graph.edges.end() || pair_of(*at) != pair) continue;
            border_mm[static_cast<std::size_t>(at - graph.edges.begin())] +=
                0.5 * (static_cast<double>(per_link[v]) + static_cast<double>(per_link[w]));
        }
    }
    return border_mm;
}

bool is_sliver(const AbstractGraph& graph, EdgeIndex e, const std::vector<float>& half_width, double width_voxels) {
    float narrowest = half_width[graph.voxel_path(e).front()];
    for (const VoxelIndex v : graph.voxel_path(e)) narrowest = std::min(narrowest, half_width[v]);
    return width_voxels < static_cast<double>(narrowest) &&
           width_voxels < kSliverShare * static_cast<double>(graph.edges[e].length_voxels);
}

}  // namespace

std::vector<float> beam_half_widths(const SurfaceVoxels& shell, const SolidStates& solid) {
    return pattern_half_width(shell.adjacency, solid, kWidestHalfVoxels);
}

BeamWidths beam_widths(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                       std::vector<float> half_width_voxels, double bridge_half_width_voxels) {
    const std::vector<float>& half_width = half_width_voxels;
    const std::vector<double> border_mm = border_lengths_mm(shell, solid, graph);
    const double voxel_mm = shell.grid.voxel_mm;
    BeamWidths widths;
    widths.is_sliver.assign(graph.edges.size(), 0);
    for (const VoxelIndex v : graph.samples) widths.at_sample_voxels.push_back(std::max(0.5f, half_width[v]));
    for (EdgeIndex e = 0; e < graph.edges.size(); ++e) {
        double width_mm = 2.0 * bridge_half_width_voxels * voxel_mm;
        if (graph.edges[e].state == EdgeState::kSolid) {
            const double along = 2.0 * harmonic_half_width(graph.voxel_path(e), half_width) * voxel_mm;
            width_mm = std::max(std::min(along, kNetFactor * border_mm[e]), 0.5 * voxel_mm);
            widths.is_sliver[e] = is_sliver(graph, e, half_width, width_mm / voxel_mm) ? 1 : 0;
        }
        widths.along_edge_mm.push_back(width_mm);
    }
    widths.half_width_voxels = std::move(half_width_voxels);
    return widths;
}

}  // namespace fretwork
