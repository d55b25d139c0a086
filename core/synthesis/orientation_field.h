// Where the picture's up points on the surface.
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/base/vec.h"
#include "core/pyramid/voxel_pyramid.h"

namespace fretwork {

/// One tangent direction per voxel of a level.
struct OrientationField {
    std::vector<Vec3f> direction;  ///< unit, tangent to the voxel
    std::vector<float> certainty;  ///< in [0, 1]; 0 where nothing defines a direction
};

struct OrientationFieldSettings {
    Vec3f direction = Vec3f::UnitZ();
    bool symmetric = false;         ///< a direction and its opposite are the same
    double smoothing_voxels = 0.0;  ///< length over which the field is evened out; 0: the bare projection
    int skipped_levels = 0;         ///< finer levels that are left out (SynthesisSettings)
};

/// Projects `direction` onto the surface of every level. The projection vanishes where the surface
/// faces along it, and has poles there; with smoothing the field minimises
///   sum |grad x|^2 + w |x - t|^2 / smoothing^2,   t the unit projection, w its squared length before,
/// carried from level to level, so that it is grown into such places from around them and cannot
/// turn faster than the pattern can follow. Certainty falls to 0 at the singularities that remain.
/// \return one field per level, finest first
std::vector<OrientationField> orientation_fields(const VoxelPyramid& pyramid, int levels,
                                                 const OrientationFieldSettings& settings, const RunControl& run = {});

/// Turns the tangent vector `x` of the plane with normal `from` into the one with normal `to`, by the
/// smallest rotation between the two. Unit normals.
[[nodiscard]] inline Vec3f turn_into_plane(const Vec3f& x, const Vec3f& from, const Vec3f& to) {
    const float cosine = from.dot(to);
    if (cosine < -0.999F) return x;  // opposite: any half turn will do
    return x - (x.dot(to) / (1.0F + cosine)) * (from + to);
}

}  // namespace fretwork
