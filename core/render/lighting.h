// Light that falls on a point: one soft key light and a sky, both shadowed by the model.
#pragma once

#include <cstdint>

#include "core/base/vec.h"
#include "core/render/camera.h"
#include "core/render/ray_scene.h"

namespace fretwork {

/// A well-spread pair of numbers in [0, 1)^2 for each sample of a pixel.
class SampleSequence {
  public:
    explicit SampleSequence(std::uint64_t pixel);
    [[nodiscard]] Vec2f at(int sample) const;

  private:
    double shift_x_, shift_y_;
};

struct Incoming {
    Vec3f diffuse = Vec3f::Zero();  ///< to be multiplied with the surface's colour
    float gloss = 0;                ///< to be added
};

class Lighting {
  public:
    Lighting(const RayScene& scene, const Camera& camera, bool shadows);

    /// \param facet   normal of the triangle towards the eye; rays leave on its side
    /// \param normal  normal to shade with
    [[nodiscard]] Incoming on_model(const Vec3f& point, const Vec3f& facet, const Vec3f& normal, const Vec3f& to_eye,
                                    const SampleSequence& random, int sample) const;

    /// Share of the light on an open floor that arrives at a point of it, in [0, 1].
    [[nodiscard]] float on_floor(const Vec3f& point, const SampleSequence& random, int sample) const;

  private:
    [[nodiscard]] bool key_is_seen(const Vec3f& point, const Vec2f& xi, Vec3f& towards) const;

    const RayScene& scene_;
    bool shadows_;
    Vec3f key_, key_side_, key_other_;
};

}  // namespace fretwork
