// Stage 4d: Algorithm 5, CONNECTSAMPLES.
#pragma once

#include "core/base/run_control.h"
#include "core/graph/abstract_graph.h"
#include "core/graph/shortest_path_forest.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Grows a tree from every sample through the solid voxels; trees that touch there make a solid
/// edge. The same trees grow on over all of G_surface; trees that touch only then make an empty edge.
/// Of all places where two trees touch, the edge takes the one with the shortest path between the
/// samples (for empty edges, with ExtendFrom::kTree, the shortest gap).
///
/// Promise  samples are joined by solid edges exactly when a path of solid voxels joins them, provided
///          that every solid component has a sample.
/// Cost     two passes over the links, and sorting the links between trees.
/// \param samples  solid voxels, ascending, without repeats
/// \throws InvalidInput  a sample that is not solid or out of order.
/// \throws Cancelled     `run` asked to stop.
AbstractGraph connect_samples(const Adjacency& graph, const SolidStates& solid, std::vector<VoxelIndex> samples,
                              ExtendFrom extend_from, const RunControl& run = {});

}  // namespace fretwork
