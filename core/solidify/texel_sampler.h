// Reads the exemplar between its pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/vec.h"
#include "core/exemplar/exemplar.h"

namespace fretwork {

/// Positions are in pixels; pixel i covers [i, i + 1). The exemplar must outlive it.
class TexelSampler {
  public:
    explicit TexelSampler(const Exemplar& exemplar);

    /// Bilinear feature distance, in pixels.
    [[nodiscard]] double feature_distance(double u, double v) const;

    /// Bilinear colour, in bytes before rounding; where the exemplar is empty, that of the nearest solid pixel, because
    /// what shows there is material that was added after the fact. So it is in the last pixel of solid, whose colour is
    /// mixed with that of the opening: hole walls stand there.
    [[nodiscard]] Vec3 solid_color(double u, double v) const;

  private:
    struct Corners {
        std::size_t pixel[4];
        double weight[4];
    };
    [[nodiscard]] Corners corners(double u, double v) const;
    [[nodiscard]] std::size_t index(long x, long y) const;

    const Exemplar* exemplar_;
    std::vector<std::uint32_t> nearest_solid_;  ///< per pixel
};

}  // namespace fretwork
