#include "core/graph/pattern_width.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/graph/shortest_path_forest.h"

namespace fretwork {
namespace {

/// A strand's middle is reached when the distance to its border rises by less than this share of the step.
constexpr float kSteep = 0.5f;

/// Solid voxels and the empty ones beside them, which are all that a distance to the border needs.
std::vector<std::uint8_t> pattern_and_rim(const Adjacency& graph, const SolidStates& solid) {
    std::vector<std::uint8_t> included(solid.size());
    parallel_for(solid.size(), 4096, [&](std::size_t v) {
        const auto is_solid = [&](VoxelIndex w) { return solid[w] == SolidState::kSolid; };
        const auto links = graph.of(static_cast<VoxelIndex>(v));
        included[v] = is_solid(static_cast<VoxelIndex>(v)) || std::ranges::any_of(links, is_solid) ? 1 : 0;
    });
    return included;
}

/// Distance from each solid voxel to the border of the pattern; 0 in empty ones.
std::vector<float> depth_in_pattern(const Adjacency& graph, const SolidStates& solid, double widest_voxels) {
    const std::vector<std::uint8_t> included = pattern_and_rim(graph, solid);
    ForestGrower grower(graph, included);
    for (VoxelIndex v = 0; v < solid.size(); ++v)
        if (solid[v] == SolidState::kEmpty && included[v] != 0) grower.plant(v, 0);
    grower.grow(to_distance(widest_voxels + 2.0));
    std::vector<float> depth(solid.size(), 0.0f);
    parallel_for(solid.size(), 4096, [&](std::size_t v) {
        if (solid[v] == SolidState::kEmpty) return;
        const GraphDistance d = grower.forest().distance[v];
        depth[v] = static_cast<float>(d == kUnreached ? widest_voxels : std::min(widest_voxels, to_voxels(d) - 0.5));
    });
    return depth;
}

}  // namespace

std::vector<float> pattern_half_width(const Adjacency& graph, const SolidStates& solid, double widest_voxels) {
    const std::size_t n = solid.size();
    const std::vector<float> depth = depth_in_pattern(graph, solid, widest_voxels);
    std::vector<float> half_width(n, 0.0f);
    parallel_for(n, 4096, [&](std::size_t start) {
        auto v = static_cast<VoxelIndex>(start);
        if (solid[v] == SolidState::kEmpty) return;
        for (bool climbs = true; climbs;) {
            climbs = false;
            float steepest = kSteep;
            VoxelIndex next = v;
            for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
                const float rise = (depth[graph.neighbor[e]] - depth[v]) / graph.length_voxels[e];
                if (rise <= steepest) continue;
                steepest = rise;
                next = graph.neighbor[e];
                climbs = true;
            }
            v = next;
        }
        half_width[start] = depth[v];
    });
    return half_width;
}

}  // namespace fretwork
