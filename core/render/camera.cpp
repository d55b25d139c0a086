#include "core/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace fretwork {

Camera::Camera(std::span<const Vec3> points_mm, const RenderSettings& settings)
    : size_px_(settings.width, settings.height) {
    const double azimuth = settings.azimuth_deg * std::numbers::pi / 180;
    const double elevation = settings.elevation_deg * std::numbers::pi / 180;
    // The frame follows from both angles, so that it is defined when the eye looks straight down.
    right_ = Vec3(std::cos(azimuth), std::sin(azimuth), 0);
    const Vec3 to_eye(std::sin(azimuth) * std::cos(elevation), -std::cos(azimuth) * std::cos(elevation),
                      std::sin(elevation));
    forward_ = -to_eye;
    up_ = to_eye.cross(right_);

    Vec3 low = points_mm[0], high = points_mm[0];
    for (const Vec3& p : points_mm) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    const Vec3 middle = low / 2 + high / 2;

    // As near as lets every point into the field of view.
    const double half_field = std::tan(settings.field_of_view_deg * std::numbers::pi / 360);
    double away = 0;
    for (const Vec3& p : points_mm) {
        const Vec3 q = p - middle;
        const double aside = std::max(std::abs(q.dot(right_)), std::abs(q.dot(up_)));
        away = std::max(away, q.dot(to_eye) + std::max(aside, 1e-6 * (high - low).norm()) / half_field);
    }
    if (!(away > 0)) away = 1;
    eye_ = middle + away * to_eye;

    // Then shift and scale the picture on the image plane to frame what is seen; this bends no perspective.
    Vec2 least = Vec2::Constant(1e300), most = Vec2::Constant(-1e300);
    for (const Vec3& p : points_mm) {
        const Vec3 q = p - eye_;
        const Vec2 at = Vec2(q.dot(right_), q.dot(up_)) / q.dot(forward_);
        least = least.cwiseMin(at);
        most = most.cwiseMax(at);
    }
    constexpr double kMargin = 1.05;
    pixel_ = kMargin * std::max((most - least).cwiseQuotient(size_px_).maxCoeff(), 1e-9);
    pixel_ /= settings.zoom;
    plane_middle_ = (least + most) / 2;
    if (settings.look_at_mm) {
        const Vec3 q = *settings.look_at_mm - eye_;
        plane_middle_ = Vec2(q.dot(right_), q.dot(up_)) / std::max(q.dot(forward_), 1e-6 * away);
    }
}

Vec3 Camera::direction(const Vec2& pixel) const {
    const Vec2 offset = (pixel - size_px_ / 2) * pixel_;
    return (forward_ + (plane_middle_.x() + offset.x()) * right_ + (plane_middle_.y() - offset.y()) * up_).normalized();
}

Vec2 Camera::project(const Vec3& point_mm) const {
    const Vec3 q = point_mm - eye_;
    const Vec2 offset = Vec2(q.dot(right_), q.dot(up_)) / q.dot(forward_) - plane_middle_;
    return size_px_ / 2 + Vec2(offset.x(), -offset.y()) / pixel_;
}

}  // namespace fretwork
