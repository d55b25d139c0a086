// Cells: the walls of a relaxed Voronoi diagram, as in cork under a microscope.
#include "core/exemplar/builtin/families.h"
#include "core/exemplar/builtin/voronoi.h"

namespace fretwork::drawing {

PatternPictures draw_cells() {
    const Torus torus{192, 192};
    const Voronoi cells(torus, scatter(torus, 18, 6, 11));
    const Relief relief{ink(0xE76F51), ink(0xFBE9CF), ink(0x1D3557), ink(0x2A6F97), 5.0, 9.0};
    constexpr double kHalfWall = 5.0, kRounding = 3.0;
    return draw(192, 192, [&](const Vec2& p) { return shade(cells.wall(p, kRounding).distance - kHalfWall, relief); });
}

}  // namespace fretwork::drawing
