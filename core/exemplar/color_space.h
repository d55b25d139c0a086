// Conversions between the 8-bit sRGB of pictures and linear light.
#pragma once

#include <algorithm>
#include <cmath>
#include <concepts>
#include <cstdint>

#include "core/exemplar/image.h"

namespace fretwork {

/// Linear light in [0, 1] of an encoded sRGB value in [0, 1].
template <std::floating_point Real>
[[nodiscard]] Real srgb_to_linear(Real encoded) {
    return encoded <= Real(0.04045) ? encoded / Real(12.92)
                                    : std::pow((encoded + Real(0.055)) / Real(1.055), Real(2.4));
}

/// Encoded sRGB value in [0, 1]; values outside are clamped.
template <std::floating_point Real>
[[nodiscard]] Real linear_to_srgb(Real linear) {
    const Real v = std::clamp(linear, Real(0), Real(1));
    return v <= Real(0.0031308) ? Real(12.92) * v : Real(1.055) * std::pow(v, Real(1) / Real(2.4)) - Real(0.055);
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
