// Pixels -> PNG.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "core/exemplar/image.h"

namespace fretwork {

/// 8 bits, RGBA when `has_alpha`, else RGB; marked as sRGB. The same picture always gives the same bytes.
/// \throws InvalidInput  no pixel, or a number of pixels that is not width x height.
std::string write_png(const Image& image);

/// A sheet of linear data: 16 bits, `channels` of them (1, 3 or 4), without any colour space. Fast
/// rather than small.
/// \param samples  row 0 on top, channels interleaved
/// \throws InvalidInput  sizes that do not agree.
std::string write_png16(std::span<const std::uint16_t> samples, int width, int height, int channels);

/// The same for one channel of 8 bits.
std::string write_png_gray8(std::span<const std::uint8_t> samples, int width, int height);

}  // namespace fretwork
