// Windows of a pattern on a curved shell, as seen from straight above each place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/pyramid/voxel_pyramid.h"
#include "core/synthesis/labels.h"
#include "likeness/pattern_picture.h"
#include "likeness/windows.h"

namespace fretwork::likeness {

/// A pattern on a shell, as the synthesis left it or with bridges laid over it.
struct ShownPattern {
    TexelFrames frames;
    double pixels_per_voxel = 1.0;  ///< of the frames
    /// Per voxel: what is shown instead of the frame's pixel (painted), or instead of its solid channel only.
    enum class Over : std::uint8_t { kNothing, kPaint, kSolid, kEmpty };
    std::vector<Over> over;  ///< empty: nothing anywhere
    PatternPixel paint{};

    /// At distance d, in voxels and tangent, from the voxel's surface point. `reference`: the exemplar at one pixel per
    /// voxel.
    [[nodiscard]] PatternPixel at(const PatternPicture& reference, VoxelIndex v, const Vec3f& d) const;
};

/// A tangent frame that is carried over a shell: parallel transport in steps from voxel to voxel.
struct SurfacePoint {
    VoxelIndex voxel = 0;
    Vec3f beside = Vec3f::Zero();  ///< from the voxel's surface point, tangent, in voxels
    Vec3f right = Vec3f::Zero(), down = Vec3f::Zero();
};

/// Walks `right_voxels` and `down_voxels` along the frame. `beside` of the result is longer than a voxel where the walk
/// has left the surface.
SurfacePoint walk(const PyramidLevel& shell, SurfacePoint from, float right_voxels, float down_voxels);

/// Windows on levels 0 .. `levels` - 1 around `count` voxels drawn at random; right and down are those of the picture
/// at the middle voxel, as its label turns it. Those whose walk leaves the surface are dropped, together on all levels.
std::vector<Windows> surface_windows(const PyramidLevel& shell, const ShownPattern& pattern,
                                     const PatternPicture& reference, std::size_t count, int levels,
                                     std::uint64_t seed);

}  // namespace fretwork::likeness
