// Coral: the winding ridges of a brain coral.
#include <algorithm>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"
#include "core/exemplar/builtin/turing.h"

namespace fretwork::drawing {

PatternPictures draw_coral() {
    const TuringField field({.side = 96, .period_cells = 11, .bias = 0.02, .steps = 60, .seed = 8});
    const Relief relief{ink(0xE77A82), ink(0xFFC9B8), ink(0x2B0F2E), ink(0x54184F), 5.5, 6.0};
    return draw(192, 192, [&](const Vec2& p) { return shade(field.distance_px(p, 192), relief); });
}

}  // namespace fretwork::drawing
