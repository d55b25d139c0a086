// Stage 6: pieces of the pattern too small to print, and components of the mesh without a pattern.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/shell/components.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct SpeckRules {
    std::size_t least_voxels = 0;  ///< smaller pieces are specks; about pi r_pattern^2
    /// Specks that hold more than this share of the solid voxels of their component are the pattern
    /// itself (fine dots) and stay.
    double most_share = 0.2;
};

struct DroppedSpecks {
    std::vector<VoxelIndex> voxels;  ///< made empty, ascending
    std::size_t pieces = 0;
    std::size_t pieces_left = 0;
};

/// Empties the specks of each component of the shell. The largest piece of a component always stays, and
/// so does every piece that holds a voxel of `keep` (one byte per voxel; may be empty). Cost: linear.
/// \param firm              links over which pieces are counted
/// \param shell_components  components of the shell
DroppedSpecks drop_specks(const Adjacency& firm, const ShellComponents& shell_components,
                          const std::vector<std::uint8_t>& keep, const SpeckRules& rules, SolidStates& solid);

}  // namespace fretwork
