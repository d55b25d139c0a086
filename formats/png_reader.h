// PNG -> pixels.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "formats/image_file.h"

namespace fretwork {

/// All kinds of PNG: 1 to 16 bits, palette, grey, alpha, transparent colour, interlaced. Values of a
/// picture that names another gamma than that of sRGB are converted to sRGB; 16 bits are rounded.
/// \throws InvalidInput  broken, cut off, or beyond the limits.
Image read_png(std::string_view bytes, std::string_view source, const ImageLimits& limits = {});

/// Samples as they are stored: no gamma, no rounding.
struct RawPng {
    int width = 0;
    int height = 0;
    int channels = 0;  ///< 1 grey, 2 grey + alpha, 3 RGB, 4 RGBA
    int bits = 8;      ///< 8 or 16
    /// `samples[(y * width + x) * channels + c]` in [0, 2^bits - 1].
    std::vector<std::uint16_t> samples;
};

/// For data sheets (voxel stacks). Palettes become RGB, fewer than 8 bits become 8.
/// \throws InvalidInput  broken, cut off, or beyond the limits.
RawPng read_raw_png(std::string_view bytes, std::string_view source, const ImageLimits& limits = {});

}  // namespace fretwork
