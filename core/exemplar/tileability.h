// Whether a picture continues across its own borders.
#pragma once

#include <cstdint>
#include <span>

#include "core/exemplar/image.h"

namespace fretwork {

/// The step across the wrap-around border (last column to first, last row to first; mean absolute
/// difference over the line) compared with the steps between neighbouring lines inside. Each is the
/// worst of both axes, on colour and on the mask.
struct WrapStep {
    double to_mean = 0;     ///< over the mean interior step: about 1 where the picture tiles
    double to_largest = 0;  ///< over the largest interior step: at most about 1 where it tiles
};

[[nodiscard]] WrapStep measure_wrap_step(std::span<const Rgb8> color, std::span<const std::uint8_t> solid, int width,
                                         int height);

/// A picture tiles if its wrap-around step is an ordinary one: near the mean, or, up to twice the
/// mean, hardly above the largest inside (a drawing may have an edge along its border by chance).
[[nodiscard]] bool is_tileable(const WrapStep& step);

}  // namespace fretwork
