// Waves: ribbons that swell and narrow, like raked sand.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

constexpr double kSide = 192;
constexpr int kRibbons = 7;

/// How many ribbons lie above a point. Whole turns along each side make it continue across them.
double ribbon_phase(const Vec2& p) {
    const Vec2 t = 2 * std::numbers::pi / kSide * p;
    return kRibbons * p.y() / kSide + 0.62 * std::sin(t.x() + 0.5 * std::sin(t.y())) +
           0.16 * std::sin(2 * t.x() - t.y() + 1.0) + 0.10 * std::sin(3 * t.x() + 2 * t.y() + 2.1);
}

}  // namespace

PatternPictures draw_waves() {
    const Relief relief{ink(0x2B86B5), ink(0x8FD3E3), ink(0x13315C), ink(0x0B2545), 5.5, 6.0};
    return draw(192, 192, [&](const Vec2& p) {
        constexpr double kStep = 0.25;
        const double phase = ribbon_phase(p);
        const Vec2 slope((ribbon_phase(p + Vec2(kStep, 0)) - ribbon_phase(p - Vec2(kStep, 0))) / (2 * kStep),
                         (ribbon_phase(p + Vec2(0, kStep)) - ribbon_phase(p - Vec2(0, kStep))) / (2 * kStep));
        // Solid is the half of each turn around the whole numbers; the slope turns phase into px.
        const double from_middle = std::abs(phase - std::round(phase));
        const double distance = (from_middle - 0.25) / slope.norm();
        return shade(distance, relief);
    });
}

}  // namespace fretwork::drawing
