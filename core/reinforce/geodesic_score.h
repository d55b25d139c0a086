// Stage 6: the second score, the way round through the pattern (section 5.2.2).
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/graph/abstract_graph.h"

namespace fretwork {

/// Length in voxels of the shortest path over solid edges between the ends of every empty edge;
/// infinite where there is none, 0 for solid edges.
/// Cost: one Dijkstra per sample with an empty edge; parallel.
std::vector<double> geodesic_scores(const AbstractGraph& graph, std::span<const EdgeState> states,
                                    const RunControl& run = {});

/// Turns solid, one after the other, the empty edge of highest geodesic score while that is above its
/// `limit`; scores are those after all earlier additions. Adding edges only lowers scores, so an old
/// score bounds the new one, and only the front of the queue need be looked at again: the result is
/// that of renewing all scores each time.
/// \param limits   in voxels, per edge
/// \param states   updated
/// \param build    called for each edge taken; false stops the selection with that edge left empty
/// \return the highest score in units of its limit before the first addition, 0 without empty edges.
double select_by_geodesics(const AbstractGraph& graph, std::span<const double> limits, std::vector<EdgeState>& states,
                           const std::function<bool(EdgeIndex)>& build, const RunControl& run = {});

}  // namespace fretwork
