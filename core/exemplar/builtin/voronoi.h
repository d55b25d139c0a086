// Distance to the walls between Voronoi cells on a torus.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "core/exemplar/builtin/drawing.h"

namespace fretwork::drawing {

/// One cell and its neighbours, seen from a point.
struct VoronoiWall {
    std::size_t cell = 0;     ///< whose site is nearest
    double distance = 0;      ///< to the wall, corners of the cell rounded, px; positive outside of thick walls
    Vec2 from_site = {0, 0};  ///< from the site to the point
};

class Voronoi {
  public:
    Voronoi(const Torus& torus, std::vector<Vec2> sites);

    /// \param rounding  radius of the corners, px, above 0
    [[nodiscard]] VoronoiWall wall(const Vec2& p, double rounding) const;
    /// The same for walls that are `half_width` thick to each side, px, by the direction across them (a unit vector).
    [[nodiscard]] VoronoiWall wall(const Vec2& p, double rounding,
                                   const std::function<double(const Vec2&)>& half_width) const;

    [[nodiscard]] const std::vector<Vec2>& sites() const { return sites_; }

  private:
    Torus torus_;
    std::vector<Vec2> sites_;
};

}  // namespace fretwork::drawing
