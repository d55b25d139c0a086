// Signed distance to the border between solid and empty, finer than a pixel.
#pragma once

#include <span>
#include <vector>

namespace fretwork {

/// Distance of every pixel centre to the curve on which `level` changes sign, in pixels, with the
/// sign of `-level`: negative where `level > 0` (solid), positive elsewhere.
///
/// The curve is the polyline of marching squares through the pixel centres: it crosses the line
/// between two neighbours where the linear interpolation of `level` is zero, so that the grey pixels
/// of an anti-aliased drawing place it within a pixel. A two-valued mask (-0.5, +0.5) gives the
/// usual border half-way between pixels.
///
/// Exactness  let d be the true distance to the polyline. The result r obeys d <= r <= sqrt(d^2 +
///            1/2): the nearest crossing of each direction is found exactly (lower envelope of
///            parabolas, \cite meijster2000general, \cite felzenszwalb2012distance), and the segments that end there
///            are measured too. Along straight borders r = d.
/// Wrap       with `wrap` the picture continues across its borders (a torus); without, the outside
///            has no border.
/// Cost       linear in the number of pixels; parallel.
///
/// \param level  `width * height` values, row by row; 0 counts as empty
/// \returns +infinity (-infinity) everywhere if no value is above (all values are above) zero
std::vector<float> signed_distance_px(std::span<const float> level, int width, int height, bool wrap);

}  // namespace fretwork
