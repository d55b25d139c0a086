// CIE L*a*b* (D65): distances between colours about as people see them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/vec.h"
#include "core/exemplar/color_space.h"
#include "core/exemplar/image.h"

namespace fretwork {

using Lab = Vec3;

/// White of D65, and the sRGB primaries of IEC 61966-2-1 in it.
inline constexpr std::array<double, 3> kWhiteXyz = {0.95047, 1.0, 1.08883};
inline constexpr double kRgbToXyz[3][3] = {
    {0.4124564, 0.3575761, 0.1804375}, {0.2126729, 0.7151522, 0.0721750}, {0.0193339, 0.1191920, 0.9503041}};
inline constexpr double kXyzToRgb[3][3] = {
    {3.2404542, -1.5371385, -0.4985314}, {-0.9692660, 1.8760108, 0.0415560}, {0.0556434, -0.2040259, 1.0572252}};

[[nodiscard]] inline Lab srgb_to_lab(const Rgb8& color) {
    Vec3 linear;
    for (int k = 0; k < 3; ++k) linear[k] = srgb_to_linear(color[static_cast<std::size_t>(k)] / 255.0);
    Vec3 f;
    for (int row = 0; row < 3; ++row) {
        double t = 0.0;
        for (int k = 0; k < 3; ++k) t += kRgbToXyz[row][k] * linear[k];
        t /= kWhiteXyz[static_cast<std::size_t>(row)];
        f[row] = t > 216.0 / 24389.0 ? std::cbrt(t) : (24389.0 / 27.0 * t + 16.0) / 116.0;
    }
    return {116.0 * f[1] - 16.0, 500.0 * (f[0] - f[1]), 200.0 * (f[1] - f[2])};
}

/// Nearest 8-bit colour; what sRGB cannot show is clamped.
[[nodiscard]] inline Rgb8 lab_to_srgb(const Lab& lab) {
    const double fy = (lab[0] + 16.0) / 116.0;
    const std::array<double, 3> f = {fy + lab[1] / 500.0, fy, fy - lab[2] / 200.0};
    std::array<double, 3> xyz{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double cube = f[k] * f[k] * f[k];
        xyz[k] = kWhiteXyz[k] * (cube > 216.0 / 24389.0 ? cube : (116.0 * f[k] - 16.0) * 27.0 / 24389.0);
    }
    Rgb8 color{};
    for (std::size_t row = 0; row < 3; ++row) {
        double linear = 0.0;
        for (std::size_t k = 0; k < 3; ++k) linear += kXyzToRgb[row][k] * xyz[k];
        color[row] = static_cast<std::uint8_t>(std::lround(255.0 * linear_to_srgb(linear)));
    }
    return color;
}

}  // namespace fretwork
