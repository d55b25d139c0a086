// Celtic: a plait of two families of strands with turns, over and under by turns.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

// The plait lives on diamonds: squares of side kTile standing on a corner, whose sides the strands cross in the middle.
constexpr int kAcross = 6;                                    // half diagonals along each side of the picture
constexpr double kHalfDiagonal = 192.0 / kAcross;             // px
constexpr double kTile = kHalfDiagonal * 1.4142135623730951;  // side of a diamond, px
constexpr double kHalfStrand = 7.6;

enum class Tile { kCross, kTurnUp, kTurnSide };

/// A repeating arrangement of turns that closes some strands into loops.
Tile tile_at(int i, int j) {
    const int a = ((i % kAcross) + kAcross) % kAcross, b = ((j % kAcross) + kAcross) % kAcross;
    if ((a == 3 && b == 3) || (a == 0 && b == 0)) return Tile::kTurnUp;
    if ((a == 3 && b == 1) || (a == 3 && b == 5) || (a == 0 && b == 2) || (a == 0 && b == 4)) return Tile::kTurnSide;
    return Tile::kCross;
}

struct Strand {
    double from_middle;  ///< distance to the middle line of the nearest strand, px
    double under;        ///< px to the edge of the strand that passes above this one; large if none
};

Strand strand_at(const Vec2& p) {
    // Diamond (i, j), i + j even, has its middle at (i, j) half diagonals.
    const double u = (p.x() + p.y()) / (2 * kHalfDiagonal), v = (p.x() - p.y()) / (2 * kHalfDiagonal);
    const double du = std::floor(u + 0.5), dv = std::floor(v + 0.5);
    const int i = static_cast<int>(du + dv), j = static_cast<int>(du - dv);
    const Vec2 q((u - du) * kTile, (v - dv) * kTile);  // within the diamond, axes along its sides
    const Tile tile = tile_at(i, j);
    constexpr double kFar = 100;
    if (tile == Tile::kCross) {
        const bool first_above = (i % 2 + 2) % 2 == 0;
        const double above = std::abs(first_above ? q.y() : q.x()), below = std::abs(first_above ? q.x() : q.y());
        if (above < kHalfStrand || above < below) return {above, kFar};
        return {below, above - kHalfStrand};
    }
    // Two quarter turns around opposite corners.
    const double flip = tile == Tile::kTurnUp ? 1.0 : -1.0;
    const Vec2 corner(kTile / 2, flip * kTile / 2);
    const double first = std::abs((q - corner).norm() - kTile / 2), second = std::abs((q + corner).norm() - kTile / 2);
    return {std::min(first, second), kFar};
}

}  // namespace

PatternPictures draw_celtic() {
    const Ink edge = ink(0x5C3D0B), rim = ink(0xA87A28), gold = ink(0xD9A441), shine = ink(0xFFE9A8);
    const Ink moss = ink(0x12372A), fern = ink(0x1F5A41);
    return draw(192, 192, [&](const Vec2& p) -> Sample {
        const Strand s = strand_at(p);
        const double distance = s.from_middle - kHalfStrand;
        if (distance > 0) return {distance, mix(moss, fern, distance / 8)};
        Ink color = mix(rim, mix(gold, shine, (-distance - 3.6) / 3.6), -distance / 3.6);
        // The strand below darkens towards the one above.
        color = mix(edge, color, s.under / 3.5);
        return {distance, color};
    });
}

}  // namespace fretwork::drawing
