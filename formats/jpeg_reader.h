// JPEG -> pixels.
#pragma once

#include <string_view>

#include "formats/image_file.h"

namespace fretwork {

/// Grey, YCbCr, RGB, CMYK and YCCK (inverted as Adobe programs write them), baseline or progressive.
/// Turned upright as the EXIF orientation asks.
/// \throws InvalidInput  broken, cut off, or beyond the limits.
Image read_jpeg(std::string_view bytes, std::string_view source, const ImageLimits& limits = {});

}  // namespace fretwork
