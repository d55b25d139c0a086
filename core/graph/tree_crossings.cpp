#include "core/graph/tree_crossings.h"

#include <algorithm>
#include <cstddef>
#include <tuple>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

bool before(const TreeCrossing& x, const TreeCrossing& y) {
    return std::tie(x.a, x.b, x.length, x.u, x.v) < std::tie(y.a, y.b, y.length, y.u, y.v);
}

void keep_best_of_each_pair(std::vector<TreeCrossing>& crossings) {
    std::ranges::sort(crossings, before);
    const auto same_pair = [](const TreeCrossing& x, const TreeCrossing& y) { return x.a == y.a && x.b == y.b; };
    crossings.erase(std::unique(crossings.begin(), crossings.end(), same_pair), crossings.end());
}

}  // namespace

std::vector<TreeCrossing> shortest_crossings(const Adjacency& graph, const ShortestPathForest& forest,
                                             const SolidStates& solid, CrossingLinks links) {
    constexpr std::size_t kGrain = 1 << 14;
    const std::size_t n = forest.distance.size();
    const auto wanted = [&](VoxelIndex u, VoxelIndex v) {
        if (links == CrossingLinks::kAny) return true;
        const bool both_solid = solid[u] == SolidState::kSolid && solid[v] == SolidState::kSolid;
        return both_solid == (links == CrossingLinks::kSolid);
    };
    std::vector<std::vector<TreeCrossing>> found((n + kGrain - 1) / kGrain);
    parallel_chunks(n, kGrain, [&](std::size_t begin, std::size_t end) {
        std::vector<TreeCrossing>& part = found[begin / kGrain];
        for (auto u = static_cast<VoxelIndex>(begin); u < end; ++u) {
            if (forest.distance[u] == kUnreached) continue;
            for (std::uint32_t e = graph.first[u]; e < graph.first[u + 1]; ++e) {
                const VoxelIndex v = graph.neighbor[e];
                // Each link is met from both ends; the end with the lower owner keeps it.
                if (forest.distance[v] == kUnreached || forest.owner[u] >= forest.owner[v] || !wanted(u, v)) continue;
                const GraphDistance step = to_distance(graph.length_voxels[e]);
                part.push_back(
                    {forest.owner[u], forest.owner[v], forest.distance[u] + step + forest.distance[v], u, v});
            }
        }
        keep_best_of_each_pair(part);
    });
    std::vector<TreeCrossing> all;
    for (const std::vector<TreeCrossing>& part : found) all.insert(all.end(), part.begin(), part.end());
    keep_best_of_each_pair(all);
    return all;
}

std::vector<VoxelIndex> path_over(const ShortestPathForest& forest, const TreeCrossing& crossing) {
    std::vector<VoxelIndex> path = path_to_source(forest, crossing.u);
    std::ranges::reverse(path);
    const std::vector<VoxelIndex> other_half = path_to_source(forest, crossing.v);
    path.insert(path.end(), other_half.begin(), other_half.end());
    return path;
}

}  // namespace fretwork
