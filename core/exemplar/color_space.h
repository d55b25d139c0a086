// Conversions between the 8-bit sRGB of pictures and linear light.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "core/exemplar/image.h"

namespace fretwork {

/// Linear light in [0, 1] of an encoded sRGB value in [0, 1].
[[nodiscard]] inline float srgb_to_linear(float encoded) {
    return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

/// Encoded sRGB value in [0, 1]; values outside are clamped.
[[nodiscard]] inline float linear_to_srgb(float linear) {
    const float v = std::clamp(linear, 0.0f, 1.0f);
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f;
}

/// Nearest 8-bit value of `unit` in [0, 1]; values outside are clamped.
[[nodiscard]] inline std::uint8_t to_byte(float unit) {
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): never negative, and this is in inner loops
    return static_cast<std::uint8_t>(std::clamp(unit, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// Luma of an encoded colour in [0, 1] (weights of Rec. 709), the brightness a user sees and cuts at.
[[nodiscard]] inline float luma(const Rgb8& c) {
    return (0.2126f * static_cast<float>(c[0]) + 0.7152f * static_cast<float>(c[1]) +
            0.0722f * static_cast<float>(c[2])) /
           255.0f;
}

}  // namespace fretwork
