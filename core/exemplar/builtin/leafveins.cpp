// Leaf veins: midribs, side veins that bend upwards, and rounded fields between finer veins.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

constexpr double kSide = 192, kHalf = kSide / 2, kPitch = kSide / 4;

/// Where the midrib lies at height y.
double midrib_x(double y) {
    return kHalf + 3.0 * std::sin(2 * std::numbers::pi * y / kSide);
}

}  // namespace

PatternPictures draw_leafveins() {
    const Torus torus{kSide, kSide};
    std::vector<Stroke> veins;
    std::vector<Vec2> rib;
    for (double y = -4; y <= kSide + 4; y += 4) rib.emplace_back(midrib_x(y), y);
    veins.emplace_back(rib, std::vector<double>(rib.size(), 7.5));
    // The margin between two leaves.
    std::vector<Vec2> margin;
    for (double y = -4; y <= kSide + 4; y += 4) margin.emplace_back(midrib_x(y) - kHalf, y);
    veins.emplace_back(margin, std::vector<double>(margin.size(), 4.6));
    // Side veins leave the midrib by turns and bend up to meet the next leaf's margin.
    for (int k = 0; k < 4; ++k)
        for (const double side : {-1.0, 1.0}) {
            const double y0 = kPitch * (k + (side > 0 ? 0.75 : 0.25));
            std::vector<Vec2> points;
            std::vector<double> radius;
            for (double t = 0; t <= 1.0001; t += 0.05) {
                points.emplace_back(midrib_x(y0) + side * kHalf * t, y0 - 34 * t - 16 * t * t);
                radius.push_back(5.6 - 1.4 * t);
            }
            veins.emplace_back(std::move(points), std::move(radius));
            // A finer vein crosses from half-way to the side vein above.
            for (const double from : {0.33, 0.64}) {
                const double x = midrib_x(y0) + side * kHalf * from, y = y0 - 34 * from - 16 * from * from;
                veins.emplace_back(
                    spline({{x, y}, {x + side * 4, y - kPitch * 0.5}, {x + side * 2, y - kPitch}}, 6, false),
                    std::vector<double>(13, 4.2));
            }
        }
    const Relief relief{ink(0x7FA83B), ink(0xCBE283), ink(0x0F2A1A), ink(0x1E4A2C), 5.0, 8.0};
    return draw(static_cast<int>(kSide), static_cast<int>(kSide), [&](const Vec2& p) {
        double distance = Stroke::kNear;
        for (const Stroke& v : veins) distance = joined(distance, v, p, torus, 7.0);
        return shade(distance, relief);
    });
}

}  // namespace fretwork::drawing
