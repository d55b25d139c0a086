// Stage 5e: what a pattern bears worst, when nobody knows its loads, after \cite zhou2013worst.
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/fem/beam_system.h"
#include "core/fem/force_profile.h"
#include "core/graph/abstract_graph.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct WorstCase {
    LoadCase load_case;
    EdgeIndex edge = 0;     ///< of the graph: the middle of the weak region
    double score_pa = 0.0;  ///< of this edge under the case
};

/// Weak regions are solid edges of highest stress in the lowest modes of the unheld object, each mode weighed by how
/// far a load of its shape moves it, a tenth of the extent apart. For each the pressure is sought, on the material that
/// belongs to the samples, that raises the edge's score most: into the surface, `total_n` in all, and in balance, with
/// moments taken on the voxels and at the samples. That is a linear program for every direction of stress; the
/// direction follows the stress until the score rises no further. At most ten places are pushed. On a sheet that no
/// pressure from one side keeps in balance, pressure may pull.
///
/// Each case is held at the material of one sample of every piece, where a load in balance leaves no reaction, and has
/// no weight. Same bits for any number of threads.
/// The states are those of the graph's edges.
/// \param system  of the same graph
/// \param settings  at least one region
/// \return at most `regions` cases, the weakest region first; none where no load is in balance
/// Cost  1 to 2 s for 1000 samples and eight regions.
/// \throws SolverFailure  the equations are singular. \throws Cancelled  `run` asked to stop.
std::vector<WorstCase> worst_cases(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                                   const BeamSystem& system, const WorstCaseSettings& settings,
                                   const RunControl& run = {});

}  // namespace fretwork
