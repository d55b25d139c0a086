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

/// A cane: from the ball at its end around the crook and down the stem to the next crook. `side` is
/// +1 or -1, the way the crook opens.
Stroke cane(const Vec2& crook_center, double side, double stem_px, double turn_rad) {
    constexpr double kCrookRadius = 15, kThin = 4.3, kThick = 6.6;
    std::vector<Vec2> knots;
    // Angles clockwise from the stem side; the crook turns three quarters and a bit.
    for (double a = 1.55 * std::numbers::pi; a > 0.05; a -= 0.1)
        knots.emplace_back(side * kCrookRadius * (1 - 0.16 * a / 4.87) * std::cos(a),
                           -kCrookRadius * (1 - 0.16 * a / 4.87) * std::sin(a));
    for (double s = 0; s <= stem_px; s += 3)
        knots.emplace_back(side * (kCrookRadius - 15 * std::pow(s / stem_px, 2.0)), s);
    std::vector<double> radius(knots.size());
    for (std::size_t i = 0; i < knots.size(); ++i) {
        const double t = static_cast<double>(i) / static_cast<double>(knots.size() - 1);
        radius[i] = kThin + (kThick - kThin) * std::max(std::exp(-30 * t * t), std::exp(-14 * (t - 0.55) * (t - 0.55)));
        const double c = std::cos(turn_rad), s = std::sin(turn_rad);
        knots[i] = crook_center + Vec2(c * knots[i].x() - s * knots[i].y(), s * knots[i].x() + c * knots[i].y());
    }
    return {std::move(knots), std::move(radius)};
}

}  // namespace

PatternPictures draw_hooks() {
    const Torus torus{192, 192};
    constexpr int kColumns = 4, kRows = 3;
    constexpr double kPitchX = 192.0 / kColumns, kPitchY = 192.0 / kRows;
    std::vector<Stroke> canes;
    for (int c = 0; c < kColumns; ++c)
        for (int r = 0; r < kRows; ++r) {
            const auto item = static_cast<std::uint64_t>(c * kRows + r);
            const double jitter = 0.16 * (random_unit(5, item, 0) - 0.5);
            const Vec2 center(kPitchX * (c + 0.5), kPitchY * (r + (c % 2 == 0 ? 0.25 : 0.75)));
            canes.push_back(cane(center, c % 2 == 0 ? 1 : -1, kPitchY - 14, jitter));
        }
    const Relief relief{ink(0x6A040F), ink(0xE85D04), ink(0xFFF3DC), ink(0xF3D9A8), 5.5, 10.0};
    return draw(192, 192, [&](const Vec2& p) {
        double distance = std::numeric_limits<double>::infinity();
        for (const Stroke& s : canes) distance = std::min(distance, s.distance(p, torus));
        return shade(distance, relief);
    });
}

}  // namespace fretwork::drawing
