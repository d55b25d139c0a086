// Stage 4d: where the trees of a shortest-path forest meet.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/graph/shortest_path_forest.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// A link between the trees of owners a < b, from voxel `u` of a's tree to voxel `v` of b's.
struct TreeCrossing {
    std::uint32_t a = 0, b = 0;
    GraphDistance length = 0;  ///< of the path between the two sources over this link
    VoxelIndex u = 0, v = 0;
};

/// Which links may join two trees.
enum class CrossingLinks {
    kSolid,     ///< between two solid voxels
    kNotSolid,  ///< with at least one empty end
    kAny,
};

/// For each pair of trees that touch over links of that kind, the crossing of least length (then of
/// lowest voxels); by (a, b). Cost: one parallel pass over the links, and a sort of what it finds.
std::vector<TreeCrossing> shortest_crossings(const Adjacency& graph, const ShortestPathForest& forest,
                                             const SolidStates& solid, CrossingLinks links);

/// Voxels from source a over the crossing to source b, both included.
std::vector<VoxelIndex> path_over(const ShortestPathForest& forest, const TreeCrossing& crossing);

}  // namespace fretwork
