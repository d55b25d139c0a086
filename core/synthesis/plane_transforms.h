// Gamma of the paper, section 4.1, without its origins: how the picture is turned within a plane.
#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/plane_set.h"
#include "core/synthesis/texel_map.h"

namespace fretwork {

/// Plane and rotation in one number: plane * rotations + rotation.
using LinearIndex = std::uint32_t;

class PlaneTransforms {
  public:
    /// \param planes  must outlive this
    PlaneTransforms(const PlaneSet& planes, int rotations, const TexelMap& map);

    [[nodiscard]] std::uint32_t rotations() const { return rotations_; }
    [[nodiscard]] LinearIndex index(PlaneIndex plane, std::uint32_t rotation) const {
        return plane * rotations_ + rotation;
    }
    [[nodiscard]] PlaneIndex plane_of(LinearIndex i) const { return i / rotations_; }

    [[nodiscard]] LinearPart linear_part(LinearIndex i) const;

    /// Rotation in `plane` whose up is closest to the projection of `up`; 0 where that vanishes.
    [[nodiscard]] std::uint32_t rotation_towards(PlaneIndex plane, const Vec3f& up) const;

    /// The picture's up direction in space, unit length.
    [[nodiscard]] Vec3f up_of(LinearIndex i) const;

  private:
    const PlaneSet* planes_;
    std::uint32_t rotations_;
    TexelMap map_;
    std::vector<float> cosine_, sine_;
};

/// Angle of (x, y) in turns, in [0, 1), to 2e-5; the same bits on every machine.
[[nodiscard]] float angle_in_turns(float x, float y);

}  // namespace fretwork
