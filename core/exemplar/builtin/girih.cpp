// Girih: eight-pointed stars and crosses of Islamic strapwork.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {
namespace {

/// Signed distance to the eight-pointed star made of two squares of inner radius `r`.
double eight_star(const Vec2& p, double r) {
    const double a = p.cwiseAbs().maxCoeff() - r;
    const double b = (std::abs(p.x()) + std::abs(p.y())) / std::numbers::sqrt2 - r;
    return std::min(a, b);
}

}  // namespace

PatternPictures draw_girih() {
    constexpr int kSide = 192, kStars = 2;
    constexpr double kPitch = static_cast<double>(kSide) / kStars, kHalfStrap = 4.0;
    const Torus cell{kPitch, kPitch};
    const Ink edge = ink(0x3AA6A0), tile = ink(0x5CC9BF), glaze = ink(0xD6F5EC);
    const Ink night = ink(0x1B1F4B), lapis = ink(0x2C3E94);
    return draw(kSide, kSide, [&](const Vec2& p) -> Sample {
        const Vec2 at_star = cell.shortest(p - Vec2::Constant(kPitch / 2));
        // Stars touch point to point; what remains between four of them is a cross. A small star fills each star.
        const double reach = kPitch / 2 / std::numbers::sqrt2;
        const double outline = std::abs(eight_star(at_star, reach));
        const double inner = std::abs(eight_star(at_star, reach * 0.46));
        // Spokes join the inner star's dents to the outer's.
        const double angle = std::atan2(at_star.y(), at_star.x());
        const double eighth = std::numbers::pi / 4;
        const double within = angle - eighth * (std::floor(angle / eighth) + 0.5);
        const double along = at_star.norm() * std::cos(within), aside = std::abs(at_star.norm() * std::sin(within));
        const double spoke =
            along > reach * 0.5 && along < reach * 1.05 ? aside : std::numeric_limits<double>::infinity();
        const double distance = smooth_min(smooth_min(outline, inner, 2.0), spoke, 2.0) - kHalfStrap;
        if (distance > 0) return {distance, mix(night, lapis, distance / 7)};
        return {distance, mix(edge, mix(tile, glaze, (-distance - 2) / 3), -distance / 2.5)};
    });
}

}  // namespace fretwork::drawing
