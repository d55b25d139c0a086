// Spirals: running double spirals, every one holding hands with its neighbours.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

// Rows lie in each other's notches: the spacing of a triangular lattice, 96 sqrt(3) / 2 = 83.1.
constexpr double kPitch = 96, kRowPitch = 83, kHalfLine = 4.8;

/// One arm from near the middle outwards, ending on the right (`turn` 0) or on the left (`turn` pi) half-way to the
/// neighbour.
std::vector<Vec2> arm(const Vec2& center, double handed, double turn) {
    constexpr double kInner = 3.8, kTurns = 1.0, kOuter = kPitch / 2;
    std::vector<Vec2> points;
    constexpr int kSteps = 60;
    for (int k = 0; k <= kSteps; ++k) {
        const double t = static_cast<double>(k) / kSteps;
        const double a = turn + handed * 2 * std::numbers::pi * kTurns * (t - 1);
        const double r = kInner + (kOuter - kInner) * t;
        points.push_back(center + r * Vec2(std::cos(a), std::sin(a)));
    }
    return points;
}

}  // namespace

PatternPictures draw_spirals() {
    const Torus torus{2 * kPitch, 2 * kRowPitch};
    std::vector<Stroke> strokes;
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 2; ++j) {
            const Vec2 center(kPitch * (i + 0.25 + 0.5 * j), kRowPitch * (j + 0.5));
            const double handed = j == 0 ? 1 : -1;
            for (const double turn : {0.0, std::numbers::pi}) {
                std::vector<Vec2> points = arm(center, handed, turn);
                std::vector<double> radius(points.size(), kHalfLine);
                strokes.emplace_back(std::move(points), std::move(radius));
            }
        }
    const Relief relief{ink(0xA8642B), ink(0xEBBC78), ink(0x123C3A), ink(0x1F6B62), 4.5, 8.0};
    // The picture's border lies where it meets edges as often as any other line does, so that it is seen to tile.
    const Vec2 corner(32, 32);
    return draw(192, 166, [&](const Vec2& pixel) {
        const Vec2 p = pixel + corner;
        double distance = Stroke::kNear;
        for (const Stroke& s : strokes) distance = joined(distance, s, p, torus, 1.5);
        return shade(distance, relief);
    });
}

}  // namespace fretwork::drawing
