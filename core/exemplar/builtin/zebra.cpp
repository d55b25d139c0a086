// Zebra: forking stripes from an anisotropic activator-inhibitor field.
#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"
#include "core/exemplar/builtin/turing.h"

namespace fretwork::drawing {

PatternPictures draw_zebra() {
    const TuringField field({.side = 96, .period_cells = 13.5, .stretch = 1.4, .bias = 0.0, .steps = 36, .seed = 7});
    const Relief relief{ink(0x231A13), ink(0x40332A), ink(0xFFF9EE), ink(0xF0E4CF), 6.0, 8.0};
    return draw(192, 192, [&](const Vec2& p) { return shade(field.distance_px(p, 192), relief); });
}

}  // namespace fretwork::drawing
