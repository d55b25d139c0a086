// Zebra: forking stripes from an anisotropic activator-inhibitor field.
#include <algorithm>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"
#include "core/exemplar/builtin/turing.h"

namespace fretwork::drawing {

PatternPictures draw_zebra() {
    const TuringField field({.side = 96, .period_cells = 13, .stretch = 1.9, .bias = 0.0, .steps = 60, .seed = 3});
    const Relief relief{ink(0x2B2118), ink(0x3D3027), ink(0xFFF9EE), ink(0xF0E4CF), 6.0, 8.0};
    return draw(192, 192, [&](const Vec2& p) {
        constexpr double kSide = 192, kStep = 0.5;
        const auto value = [&](const Vec2& q) { return field.at(q.x() / kSide, q.y() / kSide); };
        const Vec2 slope((value(p + Vec2(kStep, 0)) - value(p - Vec2(kStep, 0))) / (2 * kStep),
                         (value(p + Vec2(0, kStep)) - value(p - Vec2(0, kStep))) / (2 * kStep));
        return shade(-value(p) / std::max(slope.norm(), 0.03), relief);
    });
}

}  // namespace fretwork::drawing
