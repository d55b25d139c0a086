// Zebra: forking stripes from an anisotropic activator-inhibitor field.
#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"
#include "core/exemplar/builtin/turing.h"

namespace fretwork::drawing {

PatternPictures draw_zebra() {
    const TuringField field({.side = 96, .period_cells = 12.5, .stretch = 1.35, .bias = 0.0, .steps = 60, .seed = 3});
    const Relief relief{ink(0x231A13), ink(0x40332A), ink(0xFFF9EE), ink(0xF0E4CF), 6.0, 8.0};
    // The picture's border lies where it meets edges as often as any other line does, so that it is seen to tile.
    const Vec2 corner(2, 6);
    return draw(192, 192, [&](const Vec2& p) { return shade(field.distance_px(p + corner, 192), relief); });
}

}  // namespace fretwork::drawing
