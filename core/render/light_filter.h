// Removes the grain of few light samples without blurring edges.
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/base/vec.h"

namespace fretwork {

/// What the light samples of one pixel found, averaged over those that met the model or the floor.
struct LightPixel {
    Vec3f light = Vec3f::Zero();   ///< incoming light, linear
    Vec3f normal = Vec3f::Zero();  ///< mean normal; zero where nothing was met
    float depth = 0;               ///< mean distance from the eye
};

/// Replaces `light` by a weighted mean over 9 x 9 pixels; neighbours count the less, the more their normal turns away
/// and the farther they lie from this pixel's tangent plane. Pixels that met nothing stay as they are.
/// \param pixel_tangent  width of a pixel over its distance
/// \throws Cancelled  `run` asked to stop
std::vector<Vec3f> filter_light(const std::vector<LightPixel>& pixels, int width, int height, float pixel_tangent,
                                const RunControl& run);

}  // namespace fretwork
