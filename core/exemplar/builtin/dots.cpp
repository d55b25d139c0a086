// Dots: discs of several sizes and hues that never touch.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {

PatternPictures draw_dots() {
    const Torus torus{192, 192};
    const std::vector<Vec2> centers = scatter(torus, 30, 10, 21);
    // Each disc takes a share of the way to its nearest neighbour and leaves a gap.
    constexpr double kGap = 7.0, kLeast = 7.5, kMost = 15.0;
    std::vector<double> radius(centers.size());
    for (std::size_t i = 0; i < centers.size(); ++i) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t j = 0; j < centers.size(); ++j)
            if (j != i) nearest = std::min(nearest, torus.shortest(centers[i] - centers[j]).norm());
        const double room = (nearest - kGap) / 2;
        radius[i] = std::clamp(room * (0.70 + 0.30 * random_unit(22, i, 0)), kLeast, kMost);
    }
    const std::array<Ink, 4> hues = {ink(0xEF476F), ink(0xFFD166), ink(0x06D6A0), ink(0x118AB2)};
    const std::array<Ink, 4> rims = {ink(0xB02A50), ink(0xE09F1F), ink(0x04936E), ink(0x0B5E7A)};
    const Ink paper = ink(0x26304A), near_disc = ink(0x1B2238);
    return draw(192, 192, [&](const Vec2& p) -> Sample {
        std::size_t nearest = 0;
        double distance = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < centers.size(); ++i)
            if (const double d = torus.shortest(p - centers[i]).norm() - radius[i]; d < distance) {
                distance = d;
                nearest = i;
            }
        if (distance > 0) return {distance, mix(near_disc, paper, distance / 8)};
        const std::size_t hue = static_cast<std::size_t>(4 * random_unit(23, nearest, 0));
        return {distance, mix(rims[hue], hues[hue], -distance / 4)};
    });
}

}  // namespace fretwork::drawing
