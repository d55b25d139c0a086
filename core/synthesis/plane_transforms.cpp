#include "core/synthesis/plane_transforms.h"

#include <cmath>
#include <numbers>

namespace fretwork {

PlaneTransforms::PlaneTransforms(const PlaneSet& planes, int rotations, const TexelMap& map)
    : planes_(&planes), rotations_(static_cast<std::uint32_t>(rotations)), map_(map) {
    for (int i = 0; i < rotations; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / rotations;
        cosine_.push_back(static_cast<float>(std::cos(angle)));
        sine_.push_back(static_cast<float>(std::sin(angle)));
    }
}

LinearPart PlaneTransforms::linear_part(LinearIndex i) const {
    const PlaneIndex plane = plane_of(i);
    const std::uint32_t rotation = i - plane * rotations_;
    const float c = cosine_[rotation], s = sine_[rotation];
    const Vec3f &right = planes_->right(plane), &up = planes_->up(plane);
    return map_.linear_part(c * right + s * up, c * up - s * right);
}

Vec3f PlaneTransforms::up_of(LinearIndex i) const {
    const PlaneIndex plane = plane_of(i);
    const std::uint32_t rotation = i - plane * rotations_;
    return cosine_[rotation] * planes_->up(plane) - sine_[rotation] * planes_->right(plane);
}

std::uint32_t PlaneTransforms::rotation_towards(PlaneIndex plane, const Vec3f& up) const {
    // Turned by theta, up points to cos(theta) up - sin(theta) right.
    const float turns = angle_in_turns(up.dot(planes_->up(plane)), -up.dot(planes_->right(plane)));
    // NOLINTNEXTLINE(bugprone-incorrect-roundings): never below zero, and in an inner loop
    const auto rotation = static_cast<std::uint32_t>(turns * static_cast<float>(rotations_) + 0.5F);
    return rotation >= rotations_ ? rotation - rotations_ : rotation;
}

float angle_in_turns(float x, float y) {
    const float ax = std::fabs(x), ay = std::fabs(y);
    const float high = ax > ay ? ax : ay, low = ax > ay ? ay : ax;
    if (!(high > 0.0F)) return 0.0F;
    const float t = low / high, t2 = t * t;
    // Odd polynomial for the arc tangent on [0, 1] (Abramowitz and Stegun 4.4.49), in turns.
    float turns = t * (0.1591336F + t2 * (-0.0525688F + t2 * (0.0286703F + t2 * (-0.0135493F + t2 * 0.0033160F))));
    if (ay > ax) turns = 0.25F - turns;
    if (x < 0.0F) turns = 0.5F - turns;
    if (y < 0.0F) turns = 1.0F - turns;
    return turns >= 1.0F ? 0.0F : turns;
}

}  // namespace fretwork
