// Colour channels as mesh files write them -> 8-bit sRGB, and back.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// What an uncoloured vertex or triangle shows in a file that colours others.
inline constexpr Rgb8 kUncolored = {204, 204, 204};

/// [0, 1] -> [0, 255]; values outside and NaN are clamped.
[[nodiscard]] inline std::uint8_t color_from_unit(double value) {
    if (!(value > 0.0)) return 0;
    return value >= 1.0 ? std::uint8_t{255} : static_cast<std::uint8_t>(std::lround(255.0 * value));
}

/// "#RRGGBB"
[[nodiscard]] inline std::string hex_color(const Rgb8& color) {
    constexpr std::string_view digits = "0123456789ABCDEF";
    std::string text = "#";
    for (const std::uint8_t channel : color) {
        text += digits[channel >> 4];
        text += digits[channel & 15];
    }
    return text;
}

/// A triangle shows the mean of its corners' colours.
[[nodiscard]] inline std::vector<Rgb8> mean_of_corners(const std::vector<Triangle>& triangles,
                                                       const std::vector<Rgb8>& vertex_colors) {
    std::vector<Rgb8> colors(triangles.size());
    for (std::size_t t = 0; t < triangles.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            unsigned sum = 0;
            for (const std::uint32_t v : triangles[t]) sum += vertex_colors[v][k];
            colors[t][k] = static_cast<std::uint8_t>((sum + 1) / 3);
        }
    return colors;
}

}  // namespace fretwork
