// From solid and empty voxels to a border without stairs.
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/enlarge/geodesic_links.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Signed geodesic distance to the border between the states, in voxels, negative in solid, saturated at
/// +-kBorderReach. The border runs halfway between neighbouring voxels of different state.
constexpr double kBorderReach = 4.0;
std::vector<float> signed_border_distance(const GeodesicLinks& links, const VoxelMask& solid, const RunControl& run);

/// Gradient along the surface at each voxel's point, per voxel length: weighted least squares over the links.
std::vector<Vec3f> surface_gradient(const SurfaceVoxels& shell, const GeodesicLinks& links,
                                    const std::vector<float>& value);

/// Averages each voxel not `fixed` with its neighbours along the level line through it, so that straight strips keep
/// their width however thin they are, while stairs level out. Stays within half a voxel of `anchor`.
void smooth_along_levels(const SurfaceVoxels& shell, const GeodesicLinks& links, const std::vector<float>& anchor,
                         const VoxelMask& fixed, std::vector<float>& value, const RunControl& run);

}  // namespace fretwork
