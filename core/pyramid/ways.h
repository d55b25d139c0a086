// Inside of the pyramid: ways of at most two links between entries, and how they are laid flat around creases.
#pragma once

#include <optional>

#include "core/base/bulk_vector.h"
#include "core/pyramid/voxel_pyramid.h"

namespace fretwork {

/// A step between two entries whose normals have a cosine below this is not taken. Steps over a right-angled
/// edge are, with room for skewed mean normals; steps from one side of a wall to the other are not.
inline constexpr float kTurningRoundCosine = -0.2F;

/// Ways of at most two links between two entries.
class Ways {
  public:
    /// `level` must outlive this.
    explicit Ways(const PyramidLevel& level);

    /// The entry in the middle of the two steps from v to w whose smaller cosine is largest; v where the direct link
    /// bends no more.
    [[nodiscard]] VoxelIndex least_bent(VoxelIndex v, VoxelIndex w) const;

    /// Of the normals at the ends of a link.
    [[nodiscard]] float cosine_of_link(std::size_t e) const { return cosine_[e]; }

  private:
    const PyramidLevel& level_;
    BulkVector<float> cosine_;
};

/// Lays flat, one by one, the ways that flat_ways.h leaves: those around creases.
class Unfolder {
  public:
    Unfolder(const PyramidLevel& level, const Ways& ways) : level_(level), ways_(ways) {}

    struct BothWays {
        Vec3f out;   ///< from v to w, in the plane of v
        Vec3f back;  ///< from w to v, in the plane of w
    };
    /// In the unit of the positions. A rounded edge is followed in two steps; a sharp one, over which no smooth way
    /// leads, is a hinge.
    [[nodiscard]] BothWays unfold(VoxelIndex v, VoxelIndex w, bool smooth_way) const;

  private:
    [[nodiscard]] Vec3f over(VoxelIndex v, VoxelIndex between, VoxelIndex w) const;
    [[nodiscard]] Vec3f one_step(VoxelIndex v, VoxelIndex w) const;
    [[nodiscard]] std::optional<Vec3f> around_hinge(VoxelIndex v, VoxelIndex w) const;

    const PyramidLevel& level_;
    const Ways& ways_;
};

}  // namespace fretwork
