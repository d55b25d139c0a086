// Zebra: forking stripes from an anisotropic activator-inhibitor field. The light ones stand, and what is seen through
// the openings between them makes the dark ones.
#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"
#include "core/exemplar/builtin/turing.h"

namespace fretwork::drawing {

PatternPictures draw_zebra() {
    const TuringField field({.side = 96, .period_cells = 12.5, .stretch = 1.35, .bias = 0.0, .steps = 60, .seed = 3});
    const Relief relief{ink(0xE6D8C0), ink(0xFCF6EA), ink(0x2E231B), ink(0x453830), 6.0, 8.0};
    // The picture's border lies where it meets edges as often as any other line does, so that it is seen to tile.
    const Vec2 corner(2, 6);
    return draw(192, 192, [&](const Vec2& p) { return shade(-field.distance_px(p + corner, 192), relief); });
}

}  // namespace fretwork::drawing
