// Scales: rows of overlapping fans with an arched opening and a drop in each.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {

PatternPictures draw_scales() {
    constexpr int kWidth = 192, kHeight = 192, kPerRow = 3, kRows = 6;
    constexpr double kPitchX = static_cast<double>(kWidth) / kPerRow, kPitchY = static_cast<double>(kHeight) / kRows;
    constexpr double kRadius = kPitchX / 2 + 5.0, kHalfBand = 4.8;
    const Torus torus{kWidth, kHeight};
    const Ink edge = ink(0x17788A), jade = ink(0x2EC4B6), foam = ink(0xE9FBF4), gold = ink(0xF2C14E);
    const Ink deep = ink(0x061A2B), sea = ink(0x0A3049);
    // The picture's border lies where it meets edges as often as any other line does, so that it is seen to tile.
    const Vec2 corner(2, 10);
    return draw(kWidth, kHeight, [&](const Vec2& pixel) -> Sample {
        const Vec2 p = pixel + corner;
        // The lowest row that covers a point is seen, like roof tiles laid from above.
        double best_y = -std::numeric_limits<double>::infinity();
        Vec2 way = Vec2::Zero();
        for (int r = 0; r < kRows; ++r)
            for (int c = 0; c < kPerRow; ++c) {
                const Vec2 center((c + 0.25 + 0.5 * (r % 2)) * kPitchX, (r + 0.5) * kPitchY);
                const Vec2 q = torus.shortest(p - center);
                if (q.norm() <= kRadius && -q.y() > best_y) {
                    best_y = -q.y();
                    way = q;
                }
            }
        const double r = way.norm();
        const double outer = std::abs(r - (kRadius - kHalfBand)) - kHalfBand;
        const double inner = std::abs(r - (kRadius - 5.1 * kHalfBand)) - kHalfBand * 0.92;
        const double distance = std::min(outer, inner);
        if (distance > 0) return {distance, mix(deep, sea, distance / 5)};
        const Ink body = outer < inner ? mix(jade, foam, (-distance - 2) / 3) : mix(gold, foam, (-distance - 3) / 3);
        return {distance, mix(edge, body, -distance / 2.5)};
    });
}

}  // namespace fretwork::drawing
