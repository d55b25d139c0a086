// The pattern as a smooth function on the surface, finer than the voxels it was decided on.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "core/base/run_control.h"
#include "core/enlarge/geodesic_links.h"
#include "core/exemplar/exemplar.h"
#include "core/mesh/region.h"
#include "core/shell/surface_voxels.h"
#include "core/synthesis/labels.h"

namespace fretwork {

/// Signed distance to the pattern's border along the surface, in voxels, about distance-valued near
/// zero, negative in solid. The labels say where the border runs below the voxel scale; the voxel
/// states, which reinforcement and enlargement have changed, say on which side of it each voxel
/// lies. Constant along the surface normal by construction, as it is asked on the surface only.
///
/// Border  where the labels of neighbouring voxels agree with each other and with the states, it is
///         the zero line of the exemplar's feature distance; elsewhere it is that of the states'
///         geodesic distance, smoothed along its own level lines by at most half a voxel.
/// Safe to query from several threads. References must outlive it.
/// Cost  building about 2 s per million voxels; a query about a microsecond.
class PatternField {
  public:
    /// \param mesh   from which `shell` was voxelised: a point's triangle tells which sheet it is on
    /// \param links  of the shell, by `link_two_rings`
    /// \param keep   regions that stay solid up to a clean border; may be empty
    /// \param kept_colors  what those regions show, one per triangle of `mesh`; empty: the exemplar's colours
    /// \throws InvalidInput  states, frames or colours that do not match the shell and the mesh
    PatternField(const TriangleMesh& mesh, const SurfaceVoxels& shell, const GeodesicLinks& links,
                 const SolidStates& solid, const TexelFrames& frames, const Exemplar& exemplar, const RegionField& keep,
                 const RunControl& run = {}, std::span<const Rgb8> kept_colors = {});
    /// A pattern known by formula; the functions get a surface point and its triangle.
    PatternField(std::function<double(const Vec3&, std::uint32_t)> signed_distance_voxels,
                 std::function<Rgb8(const Vec3&, std::uint32_t)> color);
    ~PatternField();
    PatternField(PatternField&&) noexcept;
    PatternField& operator=(PatternField&&) noexcept;

    /// \param point_mm  on the surface, on `triangle`
    [[nodiscard]] double signed_distance_voxels(const Vec3& point_mm, std::uint32_t triangle) const;

    /// Colour of the exemplar there, sRGB.
    [[nodiscard]] Rgb8 color(const Vec3& point_mm, std::uint32_t triangle) const;

  private:
    struct Impl;
    std::unique_ptr<const Impl> impl_;
};

}  // namespace fretwork
