// Stripes and spots that grow by themselves: activator-inhibitor relaxation on a torus.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/vec.h"

namespace fretwork::drawing {

struct TuringSettings {
    int side = 96;             ///< cells per side of the grid
    double period_cells = 14;  ///< distance between stripes
    double stretch = 1.0;      ///< above 1: stripes run along y; reach of the activator along y over x
    double bias = 0.0;         ///< positive favours solid
    int steps = 60;
    std::uint64_t seed = 1;
};

/// A smooth field in [-1, 1], positive in solid, periodic on the unit square.
class TuringField {
  public:
    explicit TuringField(const TuringSettings& settings);
    /// Bicubic (B-spline) value at (x, y) in [0, 1)^2, continued periodically.
    [[nodiscard]] double at(double x, double y) const;
    /// About the distance to the border for a picture of `side_px`, px; negative in solid.
    [[nodiscard]] double distance_px(const Vec2& p, double side_px) const;

  private:
    int side_;
    std::vector<double> value_;
};

}  // namespace fretwork::drawing
