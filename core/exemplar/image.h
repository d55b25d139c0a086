// A picture in memory.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fretwork {

using Rgb8 = std::array<std::uint8_t, 3>;
using Rgba8 = std::array<std::uint8_t, 4>;

/// sRGB with straight alpha, row 0 on top, `pixels[y * width + x]`.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<Rgba8> pixels;
    bool has_alpha = false;  ///< the source carried transparency

    [[nodiscard]] const Rgba8& at(int x, int y) const {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

}  // namespace fretwork
