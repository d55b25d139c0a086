// Pictures at another size.
#pragma once

#include "core/exemplar/image.h"

namespace fretwork {

/// Scales a picture to `width` x `height` pixels, each axis for itself: the area filter where it
/// shrinks, linear interpolation where it grows. Works in linear light with premultiplied alpha, so
/// that fine black and white lines average to the grey one sees from afar and transparent pixels
/// lend no colour.
///
/// \throws InvalidInput  a side below 1 px, or a picture whose pixel count is not width * height.
Image resample_image(const Image& picture, int width, int height);

}  // namespace fretwork
