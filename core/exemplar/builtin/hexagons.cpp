// Hexagons: a honeycomb with rounded openings.
#include <cmath>
#include <limits>
#include <numbers>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {

PatternPictures draw_hexagons() {
    // Four columns and four rows of hexagons of side 32: 4 sqrt(3) 32 = 221.7 wide, rounded to 222.
    constexpr int kWidth = 222, kHeight = 192, kColumns = 4, kRows = 4;
    const Torus torus{kWidth, kHeight};
    const Relief relief{ink(0xC67C12), ink(0xFFC64F), ink(0x2D1A05), ink(0x4A2C0A), 5.5, 9.0};
    return draw(kWidth, kHeight, [&](const Vec2& p) {
        constexpr double kApothem = kWidth / (2.0 * kColumns), kHalfWall = 5.0, kCorner = 6.0;
        Vec2 way = Vec2::Constant(std::numeric_limits<double>::max() / 4);
        for (int r = 0; r < kRows; ++r)
            for (int c = 0; c < kColumns; ++c) {
                const Vec2 center((c + 0.25 + (r % 2) * 0.5) * 2 * kApothem, r * static_cast<double>(kHeight) / kRows);
                if (const Vec2 w = torus.shortest(p - center); w.squaredNorm() < way.squaredNorm()) way = w;
            }
        return shade(-regular_polygon(way, 6, kApothem - kHalfWall, kCorner, 0.0), relief);
    });
}

}  // namespace fretwork::drawing
