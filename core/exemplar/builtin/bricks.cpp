// Bricks: the joints of a running bond stand, the bricks are openings.
#include <cmath>

#include "core/exemplar/builtin/drawing.h"
#include "core/exemplar/builtin/families.h"

namespace fretwork::drawing {

PatternPictures draw_bricks() {
    constexpr int kSide = 192, kCourses = 6, kPerCourse = 3;
    const Relief relief{ink(0xA9492B), ink(0xDC7F55), ink(0x3A2A26), ink(0x5B433B), 5.0, 10.0};
    return draw(kSide, kSide, [&](const Vec2& p) {
        constexpr double kHeight = static_cast<double>(kSide) / kCourses,
                         kLength = static_cast<double>(kSide) / kPerCourse;
        constexpr double kHalfJoint = 4.8, kCorner = 4.0;
        // Shifted by half a course, so that the border of the picture runs through openings.
        const double course = std::floor(p.y() / kHeight + 0.5);
        const double row = course - 2 * std::floor(course / 2);
        const double along = p.x() / kLength + 0.5 * row + 0.25;
        const Vec2 way((along - std::floor(along) - 0.5) * kLength, p.y() - course * kHeight);
        return shade(-rounded_box(way, Vec2(kLength / 2 - kHalfJoint, kHeight / 2 - kHalfJoint), kCorner), relief);
    });
}

}  // namespace fretwork::drawing
