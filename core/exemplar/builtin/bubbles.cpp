// Bubbles: round openings of many sizes, packed so that even walls remain.
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

struct Disc {
    Vec2 center;
    double radius;
};

/// Large discs first, then ever smaller ones wherever a random place leaves room.
std::vector<Disc> pack(const Torus& torus, double largest, double smallest, double wall, std::uint64_t seed) {
    std::vector<Disc> discs;
    constexpr int kSizes = 12;
    constexpr std::uint64_t kTriesPerSize = 1500;
    std::uint64_t item = 0;
    for (int s = 0; s < kSizes; ++s) {
        const double size = largest * std::pow(smallest / largest, static_cast<double>(s) / (kSizes - 1));
        for (std::uint64_t t = 0; t < kTriesPerSize; ++t, ++item) {
            const Vec2 at(torus.width * random_unit(seed, item, 0), torus.height * random_unit(seed, item, 1));
            double room = 1.12 * size;
            for (const Disc& d : discs) room = std::min(room, torus.shortest(at - d.center).norm() - d.radius - wall);
            if (room >= size) discs.push_back({at, room});
        }
    }
    return discs;
}

}  // namespace

PatternPictures draw_bubbles() {
    const Torus torus{192, 192};
    const std::vector<Disc> discs = pack(torus, 29.0, 5.5, 8.2, 61);
    const Relief relief{ink(0x9CC9E8), ink(0xEEF7FE), ink(0x10294A), ink(0x1D4E89), 4.5, 14.0};
    // The picture's border lies where it meets edges as often as any other line does, so that it is seen to tile.
    const Vec2 corner(166, 62);
    return draw(192, 192, [&](const Vec2& pixel) {
        const Vec2 p = pixel + corner;
        double outside = std::numeric_limits<double>::infinity();
        for (const Disc& d : discs) outside = std::min(outside, torus.shortest(p - d.center).norm() - d.radius);
        return shade(-outside, relief);
    });
}

}  // namespace fretwork::drawing
