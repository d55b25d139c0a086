// Hooks: wrought-iron canes in columns, each hanging on the next.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

/// A cane drawn like a scroll of bent iron: its curvature grows all the way from the straight stem to the ball that
/// ends the crook. `side` is +1 or -1, the way the crook opens.
Stroke cane(const Vec2& foot, double side) {
    constexpr double kLength = 128, kStem = -0.012, kCurl = 0.092, kGrowth = 1.15;
    constexpr double kThin = 4.2, kBelly = 5.9, kBall = 6.8;
    constexpr int kSteps = 90;
    std::vector<Vec2> points;
    std::vector<double> radius;
    Vec2 at = foot;
    double heading = -0.1;  // from up, towards `side`
    for (int k = 0; k <= kSteps; ++k) {
        const double t = static_cast<double>(k) / kSteps, step = kLength / kSteps;
        const double swell = std::sin(std::numbers::pi * std::min(1.15 * t, 1.0));
        const double ball = std::exp(-80 * (1 - t) * (1 - t));
        radius.push_back(kThin + (kBelly - kThin) * swell + (kBall - kThin) * ball);
        points.push_back(at);
        heading += step * (kStem + (kCurl - kStem) * std::pow(t, kGrowth));
        at += step * Vec2(side * std::sin(heading), -std::cos(heading));
    }
    return {std::move(points), std::move(radius)};
}

}  // namespace

PatternPictures draw_hooks() {
    constexpr int kWidth = 216, kHeight = 192, kColumns = 4, kRows = 3;
    const Torus torus{kWidth, kHeight};

    constexpr double kPitchX = static_cast<double>(kWidth) / kColumns, kPitchY = static_cast<double>(kHeight) / kRows;
    std::vector<Stroke> canes;
    for (int c = 0; c < kColumns; ++c)
        for (int r = 0; r < kRows; ++r) {
            const double side = c % 2 == 0 ? 1 : -1;
            const Vec2 foot(kPitchX * (c + 0.5) - 10 * side, kPitchY * (r + 0.5 - 0.25 * side));
            canes.push_back(cane(foot, side));
        }
    const Relief relief{ink(0xA63A0C), ink(0xEE6C1B), ink(0xFFF3DC), ink(0xF3D9A8), 5.5, 10.0};
    // The picture's border lies where it meets edges as often as any other line does, so that it is seen to tile.
    const Vec2 corner(34, 6);
    return draw(kWidth, kHeight, [&](const Vec2& pixel) {
        const Vec2 p = pixel + corner;
        double distance = std::numeric_limits<double>::infinity();
        for (const Stroke& s : canes) distance = std::min(distance, s.distance(p, torus, distance));
        return shade(distance, relief);
    });
}

}  // namespace fretwork::drawing
