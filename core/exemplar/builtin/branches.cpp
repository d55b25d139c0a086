// Branches: an open network grown along the edges of a Voronoi diagram, thick boughs and thinner twigs.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"
#include "core/exemplar/builtin/voronoi.h"

namespace fretwork::drawing {

PatternPictures draw_branches() {
    constexpr double kWidth = 192, kHeight = 224, kStretch = 1.75, kSquash = 1.12;
    const Torus torus{kWidth, kHeight / kStretch};
    const Voronoi cells(torus, scatter(torus, 14, 3, 47));
    const Ink bark = ink(0x8C5A2E), wood = ink(0xB98049), sap = ink(0xE3B778);
    const Ink sky = ink(0xDCEBDD), leaf = ink(0x9CC5A1);
    // Upright walls are boughs, those that lie across are twigs.
    const auto half_width = [](const Vec2& across) { return 2.9 + 4.4 * std::pow(across.x(), 2); };
    return draw(static_cast<int>(kWidth), static_cast<int>(kHeight), [&](const Vec2& p) -> Sample {
        const Vec2 t = 2 * std::numbers::pi * p.cwiseQuotient(Vec2(kWidth, kHeight));
        const double bend = 7 * std::sin(t.y() + 0.8) + 4 * std::sin(2 * t.y() - t.x());
        const Vec2 q((p.x() + bend), p.y() / kStretch);
        // The stretch foreshortens distances along y; the slope of the field makes up for it.
        const double distance = cells.wall(q, 4.0, half_width).distance * kSquash;
        if (distance < 0) return {distance, mix(bark, mix(wood, sap, (-distance - 3) / 6), -distance / 4)};
        return {distance, mix(leaf, sky, distance / 12)};
    });
}

}  // namespace fretwork::drawing
