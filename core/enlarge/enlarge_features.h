// Stage 7: thin places of the pattern -> the least printable width (section 6.2.1 of the paper).
#pragma once

#include <cstddef>

#include "core/base/run_control.h"
#include "core/enlarge/geodesic_links.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Widths in voxels under which the shell cannot hold a feature or a hole. Borders are drawn later, between the
/// voxels, and lean towards the empty side: a hole of 0.9 voxels as it is printed is two voxels wide here.
inline constexpr double kLeastFeatureVoxels = 2.0;
inline constexpr double kLeastHoleVoxels = 0.9;

struct EnlargeSettings {
    double min_feature_mm = 0.8;  ///< least width of solid features on the surface
    double min_hole_mm = 0.8;     ///< least width of holes; narrower ones are filled
    bool draft = false;           ///< widths may be under what the voxels can hold, and are kept as far as they can
};

struct EnlargeResult {
    SolidStates solid;
    std::size_t voxels_enlarged = 0;  ///< made solid by the dilated skeleton
    std::size_t voxels_filled = 0;    ///< made solid by filling narrow holes
    std::size_t islands_dropped = 0;
    std::size_t islands_joined = 0;
    std::size_t components = 0;  ///< of the result, over face-connected voxels and G_surface
};

/// Watershed skeleton of the solid voxels on the surface, pruned of leaves and small loops, dilated
/// geodesically to the printable radius, united with the pattern; then narrow holes are filled.
/// After it: every solid voxel lies in a geodesic disc of solid voxels of diameter `min_feature_mm` plus
/// half a voxel (which the border drawn between voxels may take away), every empty voxel in one of
/// diameter `min_hole_mm` and 1.1 voxels of empty voxels, and each connected component of the shell carries
/// one connected component of solid.
/// \param links    of the shell, by `link_two_rings`
/// \param protect  voxels that must keep their state (kept regions); may be empty
/// \throws InvalidSetting  a width that is not positive; ConstraintsNotMet  a width under the least, but for drafts
///                         (names the resolution that would do) or over half of the object.
EnlargeResult enlarge_features(const SurfaceVoxels& shell, const GeodesicLinks& links, const SolidStates& solid,
                               const std::vector<std::uint8_t>& protect, const EnlargeSettings& settings,
                               const RunControl& run = {});

}  // namespace fretwork
