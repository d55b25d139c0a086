// Stage 6: hinges in the pattern -> faces.
#pragma once

#include <optional>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

/// The fewest empty voxels that must become solid so that the solid voxels `u` and `v`, linked over an
/// edge or a corner, hang together over firm links among themselves and their common neighbours.
/// Empty when they already do; nothing when the shell offers no such way.
std::optional<std::vector<VoxelIndex>> contact_filling(const SurfaceVoxels& shell, const Adjacency& firm,
                                                       const SolidStates& solid, VoxelIndex u, VoxelIndex v);

/// Fills all contacts between solid voxels that meet in an edge or a corner alone, which would make
/// hinges and non-manifold edges. Contacts are visited in order of voxels, each once.
/// \return the voxels made solid, ascending.  Cost: linear.
std::vector<VoxelIndex> repair_contacts(const SurfaceVoxels& shell, const Adjacency& firm, SolidStates& solid);

}  // namespace fretwork
