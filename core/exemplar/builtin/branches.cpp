// Branches: an open network grown along the edges of a Voronoi diagram, thick boughs and thinner twigs.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"
#include "core/exemplar/builtin/voronoi.h"

namespace fretwork::drawing {

PatternPictures draw_branches() {
    const Torus torus{208, 208};
    const Voronoi cells(torus, scatter(torus, 16, 2, 47));
    const Ink bark = ink(0x4A2C17), wood = ink(0xB5793F), sap = ink(0xE3B778);
    const Ink sky = ink(0xDCEBDD), leaf = ink(0x9CC5A1);
    return draw(208, 208, [&](const Vec2& p) -> Sample {
        const VoronoiWall wall = cells.wall(p, 5.0);
        // Between two boughs the wall is thick where either cell says so.
        const double own = random_unit(48, wall.cell, 0);
        const double other = random_unit(48, wall.neighbor, 0);
        const double half_width = 4.2 + 6.0 * std::pow(std::max(own * other, 0.0), 1.0);
        const double distance = wall.distance - half_width;
        if (distance < 0) return {distance, mix(bark, mix(wood, sap, (-distance - 3) / 6), -distance / 4)};
        return {distance, mix(leaf, sky, distance / 12)};
    });
}

}  // namespace fretwork::drawing
