// Stage 6: which empty edges to turn solid at once.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/graph/abstract_graph.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Where and how long each edge is, for the distances between bridges.
struct EdgePlaces {
    std::vector<Vec3> middle_mm;    ///< half way between the samples
    std::vector<double> length_mm;  ///< of the voxel path
};
EdgePlaces edge_places(const SurfaceVoxels& shell, const AbstractGraph& graph);

/// Takes candidates by falling score (then rising edge), at most `most`, and cancels every further
/// one whose middle is nearer to the middle of a taken one than `cancel_factor` times the length of
/// the taken one: between two solutions of the equilibrium, scores close to a new bridge are stale.
/// \param wanted  asked for each candidate just before it is taken; false passes it over
/// \return edges in the order in which they were taken.
std::vector<EdgeIndex> select_bridges(const EdgePlaces& places, std::span<const double> scores,
                                      std::span<const EdgeIndex> candidates, std::size_t most, double cancel_factor,
                                      const std::function<bool(EdgeIndex)>& wanted = {});

/// Empty edges that join two pieces of the abstract graph over solid edges, by falling score, each time
/// joining the pieces, with cancellation as above.
std::vector<EdgeIndex> select_connections(const AbstractGraph& graph, std::span<const EdgeState> states,
                                          const EdgePlaces& places, std::span<const double> scores,
                                          double cancel_factor);

/// Pieces of the abstract graph over solid edges.
DisjointSets solid_pieces(const AbstractGraph& graph, std::span<const EdgeState> states);

}  // namespace fretwork
