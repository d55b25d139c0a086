// From a point on the surface to the surface voxel that stands for it.
#pragma once

#include <cstdint>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Dense blocks of 8^3 cells behind a coarse table: memory grows with the surface. The shell must outlive it.
class ShellIndex {
  public:
    explicit ShellIndex(const SurfaceVoxels& shell);

    static constexpr VoxelIndex kNone = ~VoxelIndex{0};

    /// The voxel whose surface point is nearest among those of the point's cell and the 26 around it, on a sheet that
    /// faces the same way. kNone if no such voxel is near.
    /// \param normal  of the surface at the point, unit
    [[nodiscard]] VoxelIndex nearest(const Vec3& point_mm, const Vec3f& normal) const;

  private:
    [[nodiscard]] VoxelIndex first_in_cell(const VoxelCoord& c) const;

    const SurfaceVoxels* shell_;
    VoxelCoord block_extent_ = {0, 0, 0};
    std::vector<std::uint32_t> block_;  ///< number of the block, kNone where it holds nothing
    std::vector<VoxelIndex> cell_;      ///< per cell of each block: its first voxel
};

}  // namespace fretwork
