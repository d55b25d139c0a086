// Keyboard: rounded keys of several widths, each on its own.
#include <array>
#include <cmath>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

constexpr int kRows = 5;
constexpr double kSide = 200, kUnit = kSide / kRows;

/// Right borders of the keys of each row, in units; every row is five units wide and starts somewhere else, so that
/// the joints are staggered as on a real keyboard.
struct Row {
    double start;
    std::array<double, 5> right;
};
constexpr std::array<Row, kRows> kLayout = {{{0.30, {1, 2, 3, 4, 5}},
                                             {0.80, {1.5, 2.5, 3.5, 5, 5}},
                                             {0.55, {1, 2, 3.75, 5, 5}},
                                             {0.05, {1, 2, 3, 4, 5}},
                                             {0.60, {1.25, 3.75, 5, 5, 5}}}};

struct Key {
    double distance;
    int number;
};

Key key_at(const Vec2& p) {
    const int r = (static_cast<int>(std::floor(p.y() / kUnit + 0.5)) + kRows) % kRows;
    const double y = p.y() - kUnit * std::floor(p.y() / kUnit + 0.5);
    const Row& row = kLayout[static_cast<std::size_t>(r)];
    double x = p.x() / kUnit - row.start;
    x -= kRows * std::floor(x / kRows);
    double left = 0;
    for (std::size_t k = 0; k < row.right.size(); ++k) {
        const double right = row.right[k];
        if (x < right) {
            constexpr double kHalfGap = 3.6, kCorner = 7.0;
            const Vec2 way((x - (left + right) / 2) * kUnit, y);
            const Vec2 half((right - left) / 2 * kUnit - kHalfGap, kUnit / 2 - kHalfGap);
            return {rounded_box(way, half, kCorner), r * 8 + static_cast<int>(k)};
        }
        left = right;
    }
    return {kUnit, 0};
}

}  // namespace

PatternPictures draw_keyboard() {
    const std::array<Ink, 4> caps = {ink(0xF4EBDD), ink(0xF4EBDD), ink(0xE7D3BC), ink(0x7FA8A3)};
    const std::array<Ink, 4> skirts = {ink(0xD2C0A9), ink(0xD2C0A9), ink(0xC0A58A), ink(0x5F8B86)};
    const Ink gap = ink(0x2B2F36), slot = ink(0x16181C);
    return draw(static_cast<int>(kSide), static_cast<int>(kSide), [&](const Vec2& p) -> Sample {
        const Key key = key_at(p);
        if (key.distance > 0) return {key.distance, mix(gap, slot, key.distance / 4)};
        const auto hue =
            static_cast<std::size_t>(3.99 * std::pow(random_unit(71, static_cast<std::uint64_t>(key.number), 0), 1.4));
        return {key.distance, mix(skirts[hue], caps[hue], (-key.distance - 1) / 5)};
    });
}

}  // namespace fretwork::drawing
