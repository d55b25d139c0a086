// The exemplar at every blur the synthesis compares, packed for the inner loop.
#pragma once

#include <cstdint>
#include <vector>

#include "core/exemplar/exemplar.h"

namespace fretwork {

/// I of the paper once per level: full size on each (a stack, not a pyramid), so that a position in
/// the exemplar means the same on all levels. Texel = r | g << 8 | b << 16 | f << 24, row 0 on top.
/// f is the feature distance, 128 on the border of the solid, smaller inside it.
struct GaussianStack {
    int width = 0;
    int height = 0;
    std::vector<std::vector<std::uint32_t>> levels;
    /// Root mean square over pixels and channels of the deviation from the mean, in units of one
    /// channel's full range; falls with the level.
    std::vector<double> contrast;
};

struct GaussianStackSettings {
    int levels = 1;                 ///< at most these, at least 1
    double pixels_per_voxel = 1.0;  ///< footprint on level l: pixels_per_voxel * 2^l
    double feature_weight = 1.0;    ///< of the squared differences of f against one colour channel, in [0, 1]
    /// Levels beyond the first one whose contrast is at most this share of the picture's own are not made; 0: all are.
    double flat_contrast = 0.0;
};

/// Blurs with sigma = 0.35 sqrt(footprint^2 - 1) pixels; around the border by wrapping where the
/// exemplar tiles and by mirroring where it does not.
/// Cost  per level: pixels times the kernel's width, two passes.
/// \throws InvalidSetting  levels < 1, a footprint that is not positive, a weight outside [0, 1].
GaussianStack build_gaussian_stack(const Exemplar& exemplar, const GaussianStackSettings& settings);

}  // namespace fretwork
