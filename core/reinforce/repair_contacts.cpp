#include "core/reinforce/repair_contacts.h"

#include <algorithm>
#include <cstddef>
#include <iterator>

namespace fretwork {
namespace {

/// u, v and the voxels linked to both, ascending.
std::vector<VoxelIndex> contact_neighborhood(const Adjacency& graph, VoxelIndex u, VoxelIndex v) {
    std::vector<VoxelIndex> around{u, v};
    const auto near_u = graph.of(u);
    const auto near_v = graph.of(v);
    std::ranges::set_intersection(near_u, near_v, std::back_inserter(around));
    std::ranges::sort(around);
    return around;
}

bool are_linked(const Adjacency& graph, VoxelIndex v, VoxelIndex w) {
    return std::ranges::binary_search(graph.of(v), w);
}

}  // namespace

std::optional<std::vector<VoxelIndex>> contact_filling(const SurfaceVoxels& shell, const Adjacency& firm,
                                                       const SolidStates& solid, VoxelIndex u, VoxelIndex v) {
    if (are_linked(firm, u, v)) return std::vector<VoxelIndex>{};
    // Most contacts have a solid voxel beside both ends already.
    for (const VoxelIndex w : firm.of(u))
        if (solid[w] == SolidState::kSolid && are_linked(firm, w, v)) return std::vector<VoxelIndex>{};
    // Dijkstra over a handful of voxels, where entering an empty one costs 1 and a solid one nothing.
    const std::vector<VoxelIndex> around = contact_neighborhood(shell.adjacency, u, v);
    const std::size_t n = around.size();
    constexpr int kFar = 1 << 20;
    std::vector<int> cost(n, kFar);
    std::vector<std::size_t> previous(n, n);
    std::vector<bool> done(n, false);
    const auto index_of = [&](VoxelIndex w) {
        return static_cast<std::size_t>(std::ranges::lower_bound(around, w) - around.begin());
    };
    cost[index_of(u)] = 0;
    for (std::size_t round = 0; round < n; ++round) {
        std::size_t at = n;
        for (std::size_t i = 0; i < n; ++i)
            if (!done[i] && cost[i] < kFar && (at == n || cost[i] < cost[at])) at = i;
        if (at == n) break;
        done[at] = true;
        for (std::size_t i = 0; i < n; ++i) {
            const int next = cost[at] + (solid[around[i]] == SolidState::kSolid ? 0 : 1);
            if (done[i] || next >= cost[i] || !are_linked(firm, around[at], around[i])) continue;
            cost[i] = next;
            previous[i] = at;
        }
    }
    std::size_t at = index_of(v);
    if (cost[at] == kFar) return std::nullopt;
    std::vector<VoxelIndex> filling;
    for (; at != n; at = previous[at])
        if (solid[around[at]] == SolidState::kEmpty) filling.push_back(around[at]);
    std::ranges::sort(filling);
    return filling;
}

std::vector<VoxelIndex> repair_contacts(const SurfaceVoxels& shell, const Adjacency& firm, SolidStates& solid) {
    std::vector<VoxelIndex> filled;
    const Adjacency& graph = shell.adjacency;
    // A filling can make new contacts with voxels already visited: repeat until a pass fills nothing.
    for (std::size_t before = 1; before != filled.size();) {
        before = filled.size();
        for (VoxelIndex u = 0; u < solid.size(); ++u) {
            if (solid[u] != SolidState::kSolid) continue;
            for (std::uint32_t e = graph.first[u]; e < graph.first[u + 1]; ++e) {
                const VoxelIndex v = graph.neighbor[e];
                if (v < u || graph.length_voxels[e] < 1.2f || solid[v] != SolidState::kSolid) continue;
                const auto filling = contact_filling(shell, firm, solid, u, v);
                if (!filling) continue;
                for (const VoxelIndex w : *filling) solid[w] = SolidState::kSolid;
                filled.insert(filled.end(), filling->begin(), filling->end());
            }
        }
    }
    std::ranges::sort(filled);
    return filled;
}

}  // namespace fretwork
