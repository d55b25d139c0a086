// Lace: rings of petals around small flowers, joined where the rings meet.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

/// Distance to the nearest of `count` equal discs on a circle; negative inside.
double disc_ring(const Vec2& p, int count, double ring_radius, double disc_radius, double turn) {
    const double sector = 2 * std::numbers::pi / count;
    const double angle = std::atan2(p.y(), p.x()) - turn;
    const double within = angle - sector * std::floor(angle / sector + 0.5);
    const Vec2 q(p.norm() * std::cos(within) - ring_radius, p.norm() * std::sin(within));
    return q.norm() - disc_radius;
}

/// The same for drops that point to the middle: discs that narrow inwards.
double drop_ring(const Vec2& p, int count, double ring_radius, double disc_radius, double tip_radius, double turn) {
    const double sector = 2 * std::numbers::pi / count;
    const double angle = std::atan2(p.y(), p.x()) - turn;
    const double within = angle - sector * std::floor(angle / sector + 0.5);
    const Vec2 q(p.norm() * std::cos(within), p.norm() * std::sin(within));
    const double inner = ring_radius * 0.52;
    const double t = std::clamp((q.x() - inner) / (ring_radius - inner), 0.0, 1.0);
    return (q - Vec2(inner + t * (ring_radius - inner), 0)).norm() - (tip_radius + t * (disc_radius - tip_radius));
}

}  // namespace

PatternPictures draw_lace() {
    // Rosettes on a triangular lattice, two per picture of 128 x 222 (128 sqrt(3) = 221.7).
    constexpr int kWidth = 128, kHeight = 222;
    const Torus torus{kWidth, kHeight};
    const Relief relief{ink(0xE6C3C8), ink(0xFFFAF5), ink(0x5B2A3C), ink(0x7A3B52), 4.5, 7.0};
    return draw(kWidth, kHeight, [&](const Vec2& p) {
        double hole = std::numeric_limits<double>::infinity();
        for (int r = 0; r < 2; ++r) {
            const Vec2 center((r + 0.5) * kWidth / 2.0, (r + 0.5) * kHeight / 2.0);
            const Vec2 q = torus.shortest(p - center);
            hole = std::min({hole, q.norm() - 8.5, drop_ring(q, 6, 35.0, 13.0, 5.0, std::numbers::pi / 6),
                             disc_ring(q, 6, 52.0, 7.0, 0.0)});
            // The middle of three rosettes: one round opening each.
            for (int k = 0; k < 6; ++k) {
                const double a = std::numbers::pi / 6 + k * std::numbers::pi / 3;
                const Vec2 triple = center + kWidth / std::numbers::sqrt3 * Vec2(std::cos(a), std::sin(a));
                hole = std::min(hole, torus.shortest(p - triple).norm() - 17.0);
            }
        }
        return shade(-hole, relief);
    });
}

}  // namespace fretwork::drawing
