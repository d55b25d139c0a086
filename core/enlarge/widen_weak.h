// Weak places of the pattern -> voxels that make them wider.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/run_control.h"
#include "core/enlarge/geodesic_links.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct WidenSettings {
    double most_voxels = 6.0;  ///< that a border may move outward; at least 1.5
    std::size_t budget = 0;    ///< most voxels to be added in all; the weakest places come first
};

/// Makes the pattern wider around solid voxels that bear too much. A strand whose stress is `gain` times what it may be
/// becomes that much wider, twice as wide at most, and by 1.5 voxels on each side at least: less would be lost between
/// voxels. Where a strand is weak along its length it grows along its length, and tapers off where the stress does.
/// \param gain  one per voxel, stress over allowable stress; solid voxels above 1 are weak
/// Weak voxels with nothing empty within `most_voxels` are left as they are.
/// \return empty voxels to be made solid, ascending
/// Cost  a disc of at most `most_voxels` per weak voxel.
std::vector<VoxelIndex> widen_weak(const SurfaceVoxels& shell, const GeodesicLinks& links, const SolidStates& solid,
                                   const std::vector<float>& gain, const WidenSettings& settings,
                                   const RunControl& run = {});

}  // namespace fretwork
