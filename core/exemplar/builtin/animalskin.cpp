// Animal skin: a leopard's rosettes, cut out of the coat.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

/// Two or three bent blobs around a centre; the gaps between them are bridges of coat.
void add_rosette(const Vec2& center, double radius, std::uint64_t item, std::vector<Stroke>& blobs) {
    const int count = random_unit(31, item, 0) < 0.45 ? 2 : 3;
    const double turn = 2 * std::numbers::pi * random_unit(31, item, 1);
    constexpr double kHalfWidth = 5.2, kBridge = 8.5;
    const double sector = 2 * std::numbers::pi / count;
    for (int b = 0; b < count; ++b) {
        const auto draw = static_cast<std::uint32_t>(4 * b + 2);
        const double span = sector - (2 * kHalfWidth + kBridge) / radius;
        const double from = turn + b * sector, bulge = 1.5 * (random_unit(31, item, draw) - 0.3);
        std::vector<Vec2> points;
        std::vector<double> widths;
        constexpr int kSteps = 10;
        for (int k = 0; k <= kSteps; ++k) {
            const double t = static_cast<double>(k) / kSteps, a = from + span * t;
            const double wobble = 1 + 0.07 * std::sin(3 * a + 6 * random_unit(31, item, draw + 1));
            points.push_back(center + radius * wobble * Vec2(std::cos(a), 0.92 * std::sin(a)));
            widths.push_back(kHalfWidth + bulge * std::sin(std::numbers::pi * t));
        }
        blobs.emplace_back(std::move(points), std::move(widths));
    }
}

}  // namespace

PatternPictures draw_animalskin() {
    const Torus torus{192, 192};
    const std::vector<Vec2> centers = scatter(torus, 16, 16, 30);
    std::vector<Stroke> blobs;
    for (std::size_t i = 0; i < centers.size(); ++i) add_rosette(centers[i], 14.5, i, blobs);
    const Ink coat = ink(0xF0C987), warm = ink(0xD69A4E);
    const Ink spot = ink(0x2A1A10), spot_core = ink(0x3B2415);
    return draw(192, 192, [&](const Vec2& p) -> Sample {
        double outside = std::numeric_limits<double>::infinity(), middle = outside;
        for (const Stroke& b : blobs) outside = std::min(outside, b.distance(p, torus, outside));
        for (const Vec2& c : centers) middle = std::min(middle, torus.shortest(p - c).norm());
        if (outside < 0) return {-outside, mix(spot, spot_core, -outside / 4)};
        // The coat is darker inside a rosette, as on the animal.
        return {-outside, mix(warm, coat, (middle - 7) / 10)};
    });
}

}  // namespace fretwork::drawing
