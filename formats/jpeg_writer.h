// Pixels -> JPEG, for pictures that are looked at and not worked with.
#pragma once

#include <string>

#include "core/exemplar/image.h"

namespace fretwork {

/// Baseline, without alpha, colours at full resolution. The same picture always gives the same bytes.
/// \param quality  1 to 100, as libjpeg has it
/// \throws InvalidInput  no pixel, a number of pixels that is not width x height, over 65500 of them along a side.
std::string write_jpeg(const Image& image, int quality = 85);

}  // namespace fretwork
