#include "core/enlarge/ridge_skeleton.h"

#include <algorithm>
#include <cstdint>
#include <queue>
#include <tuple>
#include <utility>

namespace fretwork {
namespace {

constexpr VoxelIndex kNone = ~VoxelIndex{0};

/// Spanning forest of the solid voxels in which the path between any two stays as far from empty as it can.
struct RidgeForest {
    std::vector<VoxelIndex> parent;  ///< kNone at roots and outside the solid
    std::vector<float> depth;        ///< path length to the root
    std::vector<VoxelIndex> order;   ///< parents before children
};

float step_length(const SurfaceVoxels& shell, VoxelIndex a, VoxelIndex b) {
    return static_cast<float>((shell.points_mm[a] - shell.points_mm[b]).norm() / shell.grid.voxel_mm);
}

/// Prim's tree over heights: the highest voxel of the front is taken next, of equals the one with the highest parent,
/// so that flanks hang from their ridge and do not string along it, then the one nearest to the root.
RidgeForest flood(const SurfaceVoxels& shell, const VoxelMask& solid, const std::vector<float>& height,
                  const RunControl& run) {
    struct Front {
        float height, parent_height, depth;
        VoxelIndex voxel, parent;
        bool operator<(const Front& o) const {
            return std::tuple(height, parent_height, -depth, o.voxel, o.parent) <
                   std::tuple(o.height, o.parent_height, -o.depth, voxel, parent);
        }
    };
    RidgeForest forest;
    forest.parent.assign(shell.size(), kNone);
    forest.depth.assign(shell.size(), 0.0F);
    std::vector<VoxelIndex> seeds;
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (solid[v] != 0) seeds.push_back(v);
    std::stable_sort(seeds.begin(), seeds.end(), [&](VoxelIndex a, VoxelIndex b) { return height[a] > height[b]; });

    VoxelMask done(shell.size(), 0);
    std::priority_queue<Front> front;
    for (const VoxelIndex seed : seeds) {
        if (done[seed] != 0) continue;
        front.push({height[seed], height[seed], 0.0F, seed, kNone});
        while (!front.empty()) {
            const Front f = front.top();
            front.pop();
            if (done[f.voxel] != 0) continue;
            done[f.voxel] = 1;
            forest.parent[f.voxel] = f.parent;
            forest.depth[f.voxel] = f.depth;
            forest.order.push_back(f.voxel);
            if ((forest.order.size() & 0xFFF) == 0) run.throw_if_stopped();
            for (const VoxelIndex u : shell.adjacency.of(f.voxel))
                if (solid[u] != 0 && done[u] == 0)
                    front.push({height[u], height[f.voxel], f.depth + step_length(shell, f.voxel, u), u, f.voxel});
        }
    }
    return forest;
}

/// Keeps the tree's voxels that have at least `shortest` of branch beyond them, and then follows each kept end along
/// its longest branch until `tip` before the branch ends, so that long branches keep their length.
VoxelMask prune_leaves(const RidgeForest& forest, VoxelMask needed, float shortest, float tip) {
    const std::size_t count = needed.size();
    std::vector<float> beyond(count, 0.0F);
    std::vector<VoxelIndex> longest_child(count, kNone);
    for (auto it = forest.order.rbegin(); it != forest.order.rend(); ++it) {
        const VoxelIndex p = forest.parent[*it];
        if (p == kNone || needed[*it] == 0) continue;
        needed[p] = 1;
        const float length = beyond[*it] + forest.depth[*it] - forest.depth[p];
        if (longest_child[p] != kNone && length <= beyond[p]) continue;
        beyond[p] = length;
        longest_child[p] = *it;
    }
    VoxelMask kept(count, 0);
    for (const VoxelIndex v : forest.order) {
        const VoxelIndex p = forest.parent[v];
        const bool continues = p != kNone && kept[p] != 0 && longest_child[p] == v && beyond[v] >= tip;
        // A root's own branches may all be short: then the whole piece is smaller than a leaf and stays out.
        kept[v] = needed[v] != 0 && (beyond[v] >= shortest || continues) ? 1 : 0;
    }
    return kept;
}

/// Length of the cycle that the edge (a, b) closes in the forest; stops early once it exceeds `enough`.
float cycle_length(const RidgeForest& forest, VoxelIndex a, VoxelIndex b, float edge, float enough) {
    float length = edge;
    while (a != b && length < enough) {
        VoxelIndex& deeper = forest.depth[a] >= forest.depth[b] ? a : b;
        const VoxelIndex p = forest.parent[deeper];
        if (p == kNone) return kBeyondReach;
        length += forest.depth[deeper] - forest.depth[p];
        deeper = p;
    }
    return length;
}

struct Pass {
    float height;
    VoxelIndex a, b;
};

/// Edges outside the core that are not in the forest and close a long loop, the highest first.
std::vector<Pass> loop_passes(const SurfaceVoxels& shell, const VoxelMask& solid, const std::vector<float>& height,
                              const VoxelMask& wide_enough, const RidgeForest& forest, const SkeletonSettings& settings,
                              const RunControl& run) {
    std::vector<Pass> passes;
    const auto core = static_cast<float>(settings.core_radius_voxels);
    const auto shortest = static_cast<float>(settings.shortest_loop_voxels);
    for (const VoxelIndex a : forest.order) {
        if ((a & 0xFFF) == 0) run.throw_if_stopped();
        for (const VoxelIndex b : shell.adjacency.of(a)) {
            const float low = std::min(height[a], height[b]);
            if (b < a || solid[b] == 0 || low >= core) continue;
            if (forest.parent[a] == b || forest.parent[b] == a || (wide_enough[a] != 0 && wide_enough[b] != 0))
                continue;
            if (cycle_length(forest, a, b, step_length(shell, a, b), shortest) >= shortest)
                passes.push_back({low, a, b});
        }
    }
    std::stable_sort(passes.begin(), passes.end(), [](const Pass& p, const Pass& q) {
        return std::tuple(-p.height, p.a, p.b) < std::tuple(-q.height, q.a, q.b);
    });
    return passes;
}

/// Where two branches meet, many neighbouring edges close the same loop: the highest stands for those around it.
void add_loops(const SurfaceVoxels& shell, const std::vector<Pass>& passes, const RidgeForest& forest,
               VoxelMask& kept) {
    VoxelMask taken(shell.size(), 0);
    std::vector<VoxelIndex> ring;
    for (const Pass& pass : passes) {
        if (taken[pass.a] != 0 || taken[pass.b] != 0) continue;
        for (const VoxelIndex end : {pass.a, pass.b})
            for (VoxelIndex v = end; v != kNone && kept[v] == 0; v = forest.parent[v]) kept[v] = 1;
        ring.assign({pass.a, pass.b});
        for (int step = 0; step < 4; ++step) {
            const std::size_t known = ring.size();
            for (std::size_t i = 0; i < known; ++i)
                for (const VoxelIndex u : shell.adjacency.of(ring[i]))
                    if (taken[u] == 0) {
                        taken[u] = 1;
                        ring.push_back(u);
                    }
        }
    }
}

}  // namespace

VoxelMask ridge_skeleton(const SurfaceVoxels& shell, const VoxelMask& solid,
                         const std::vector<float>& distance_to_empty, const VoxelMask& wide_enough,
                         const SkeletonSettings& settings, const RunControl& run) {
    const auto core = static_cast<float>(settings.core_radius_voxels);
    std::vector<float> height(shell.size(), 0.0F);
    for (std::size_t v = 0; v < shell.size(); ++v)
        if (solid[v] != 0) height[v] = std::min(distance_to_empty[v], core);

    const RidgeForest forest = flood(shell, solid, height, run);
    VoxelMask needed(shell.size(), 0);
    for (std::size_t v = 0; v < shell.size(); ++v)
        needed[v] = solid[v] != 0 && (height[v] >= core || wide_enough[v] == 0) ? 1 : 0;
    VoxelMask kept =
        prune_leaves(forest, std::move(needed), static_cast<float>(settings.shortest_leaf_voxels), 0.5F * core);
    add_loops(shell, loop_passes(shell, solid, height, wide_enough, forest, settings, run), forest, kept);
    for (std::size_t v = 0; v < shell.size(); ++v)
        if (height[v] >= core) kept[v] = 0;
    return kept;
}

}  // namespace fretwork
