// Whether a picture continues across its own borders.
#pragma once

#include <span>

#include "core/exemplar/image.h"

namespace fretwork {

/// The step from the last column to the first one over the mean step between neighbouring columns
/// inside, and the same for rows; the larger of the two. Measured on colour and on `level` (positive
/// in solid, clamped to [-1/2, 1/2]) and again the larger taken. About 1 for a picture that tiles.
[[nodiscard]] double wrap_step_ratio(std::span<const Rgb8> color, std::span<const float> level, int width, int height);

/// The ratio up to which a picture counts as tileable. Pictures drawn to tile measure about 1, crops
/// of a larger picture above 2.
inline constexpr double kTileableStepRatio = 1.6;

}  // namespace fretwork
