// The pattern as a smooth function on the surface, finer than the voxels it was decided on.
#pragma once

#include <cstdint>
#include <memory>

#include "core/exemplar/exemplar.h"
#include "core/mesh/region.h"
#include "core/shell/surface_voxels.h"
#include "core/synthesis/labels.h"

namespace fretwork {

/// Signed distance to the pattern's border along the surface, in voxels, about distance-valued near
/// zero, negative in solid. The labels say where the border runs below the voxel scale; the voxel
/// states, which reinforcement and enlargement have changed, say on which side of it each voxel
/// lies. Safe to query from several threads. References must outlive it.
class PatternField {
  public:
    /// \param keep  regions that stay solid up to a clean border; may be empty
    PatternField(const SurfaceVoxels& shell, const SolidStates& solid, const TexelFrames& frames,
                 const Exemplar& exemplar, const RegionField& keep);
    ~PatternField();
    PatternField(PatternField&&) noexcept;
    PatternField& operator=(PatternField&&) noexcept;

    /// \param point_mm  on the surface, on `triangle`
    [[nodiscard]] double signed_distance_voxels(const Vec3& point_mm, std::uint32_t triangle) const;

    /// Colour of the exemplar there, sRGB.
    [[nodiscard]] Rgb8 color(const Vec3& point_mm, std::uint32_t triangle) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
