#include "core/graph/pattern_width.h"

#include <algorithm>

#include "core/base/parallel.h"
#include "core/graph/shortest_path_forest.h"

namespace fretwork {
namespace {

/// A strand's middle is reached when the distance to its border rises by less than this share of the step.
constexpr float kSteep = 0.5f;

}  // namespace

std::vector<float> pattern_half_width(const Adjacency& graph, const SolidStates& solid, double widest_voxels) {
    const std::size_t n = solid.size();
    ForestGrower grower(graph);
    for (VoxelIndex v = 0; v < n; ++v)
        if (solid[v] == SolidState::kEmpty) grower.plant(v, 0);
    grower.grow(to_distance(widest_voxels + 2.0));
    std::vector<float> depth(n, 0.0f);
    for (VoxelIndex v = 0; v < n; ++v) {
        const GraphDistance d = grower.forest().distance[v];
        if (d == 0) continue;
        depth[v] = static_cast<float>(d == kUnreached ? widest_voxels : std::min(widest_voxels, to_voxels(d) - 0.5));
    }

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
