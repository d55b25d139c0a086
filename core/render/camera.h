// Where the eye is and what each pixel sees.
#pragma once

#include <span>

#include "core/base/vec.h"
#include "core/render/render.h"

namespace fretwork {

/// A pinhole camera. Image plane coordinates are tangents of viewing angles: x to the right, y up.
class Camera {
  public:
    /// Frames the points in the settings' aspect with a margin of a twentieth on the tight axis. Only direction, zoom,
    /// look-at, field of view and picture size of the settings matter.
    Camera(std::span<const Vec3> points_mm, const RenderSettings& settings);

    [[nodiscard]] const Vec3& eye_mm() const { return eye_; }
    [[nodiscard]] const Vec3& right() const { return right_; }
    [[nodiscard]] const Vec3& up() const { return up_; }
    [[nodiscard]] const Vec3& forward() const { return forward_; }

    /// Unit direction through a place of the picture in pixels: (0, 0) is the upper left corner.
    [[nodiscard]] Vec3 direction(const Vec2& pixel) const;
    /// The place of a point in front of the eye, in pixels.
    [[nodiscard]] Vec2 project(const Vec3& point_mm) const;

  private:
    Vec3 eye_, right_, up_, forward_;
    Vec2 plane_middle_;  ///< image plane coordinates of the middle of the picture
    Vec2 size_px_;
    double pixel_;  ///< size of a pixel on the image plane
};

}  // namespace fretwork
