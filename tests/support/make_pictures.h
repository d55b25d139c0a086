// Small pictures made in memory.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/exemplar/image.h"

namespace fretwork::testing {

/// `pixel(x, y)` gives an Rgba8.
template <class Pixel>
Image make_picture(int width, int height, const Pixel& pixel, bool has_alpha = false) {
    Image image{width, height, {}, has_alpha};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.pixels.push_back(pixel(x, y));
    return image;
}

inline Rgba8 grey(int value, int alpha = 255) {
    const auto v = static_cast<std::uint8_t>(value);
    return {v, v, v, static_cast<std::uint8_t>(alpha)};
}

/// The part of a picture that starts at (x0, y0).
inline Image crop(const Image& image, int x0, int y0, int width, int height) {
    return make_picture(
        width, height, [&](int x, int y) { return image.at(x0 + x, y0 + y); }, image.has_alpha);
}

}  // namespace fretwork::testing
