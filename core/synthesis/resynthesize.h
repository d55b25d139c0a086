// RESYNTHESIZE of the paper, section 4.4.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/synthesis/synthesis_problem.h"

namespace fretwork {

/// The voxels of every level that a local update may touch, finest first, ascending.
using LocalVoxels = std::vector<std::vector<VoxelIndex>>;

/// The parents, `coarsest` levels up, of the changed voxels, and all that lies below them.
LocalVoxels voxels_around(const SynthesisProblem& problem, const std::vector<VoxelIndex>& changed, int coarsest);

/// Updates the choices of the local voxels from the coarsest of their levels to the finest, under the
/// constraint that forced voxels show solid. Voxels that are not listed keep their choices.
/// \param epoch  differs from call to call
/// \param all    choices per level, finest first
/// \return the finest voxels whose label changed, ascending
std::vector<VoxelIndex> update_locally(const SynthesisProblem& problem, const std::vector<std::uint8_t>& forced_solid,
                                       const LocalVoxels& local, std::uint32_t epoch, std::vector<Choices>& all,
                                       const RunControl& run);

}  // namespace fretwork
