// Geometric questions to a triangle surface, answered in double precision: what is closest, what does a segment hit,
// is a point inside.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// The point of a surface closest to a query.
struct ClosestPoint {
    Vec3 point_mm = Vec3::Zero();
    double distance_mm = std::numeric_limits<double>::infinity();  ///< infinite: nothing within reach
    std::uint32_t triangle = std::numeric_limits<std::uint32_t>::max();

    [[nodiscard]] bool found() const { return distance_mm < std::numeric_limits<double>::infinity(); }
};

/// Where a segment passes through a triangle.
struct SegmentHit {
    double parameter = 0.0;  ///< 0 at the first end, 1 at the second
    std::uint32_t triangle = 0;
    bool leaving = false;  ///< the segment runs along the triangle's normal (counter-clockwise side)
};

/// A mesh prepared for many queries. Holds what it needs of the mesh. All queries are const, safe from any number of
/// threads, and give the same answer whatever the machine's load or the number of threads: a box tree (float) only
/// chooses the candidates, each is decided in double, and ties go to the lowest triangle.
///
/// Triangles of zero area are points or segments to `closest` and invisible to `hits`.
/// Cost  building about 1 s and 250 MB per million triangles; a query a few microseconds. The first winding number
///       of an open surface costs another 2 s per million triangles.
class SurfaceTree {
  public:
    /// \throws InvalidInput  no triangle, an index past the end or a coordinate that is not finite.
    /// \throws Cancelled     `run` asked to stop.
    explicit SurfaceTree(const TriangleMesh& mesh, const RunControl& run = {});
    ~SurfaceTree();
    SurfaceTree(SurfaceTree&&) noexcept;
    SurfaceTree& operator=(SurfaceTree&&) noexcept;

    [[nodiscard]] std::size_t triangle_count() const;

    static constexpr std::uint32_t kNoHint = std::numeric_limits<std::uint32_t>::max();

    /// Closest point of the surface, exact to rounding. Nothing farther than `reach_mm` is looked for, which saves
    /// time in a narrow band.
    /// \param hint  a triangle that is likely near, or kNoHint; it saves time and changes nothing
    [[nodiscard]] ClosestPoint closest(const Vec3& point_mm, double reach_mm = std::numeric_limits<double>::infinity(),
                                       std::uint32_t hint = kNoHint) const;

    /// The same for many points, in parallel. One answer per point.
    [[nodiscard]] std::vector<ClosestPoint> closest(std::span<const Vec3> points_mm,
                                                    double reach_mm = std::numeric_limits<double>::infinity(),
                                                    const RunControl& run = {}) const;

    /// First hit of the segment from `from_mm` to `to_mm`, ends included. Watertight: which side of an edge the
    /// segment passes is decided by one number that both triangles share, so a segment cannot slip through the seam.
    [[nodiscard]] std::optional<SegmentHit> first_hit(const Vec3& from_mm, const Vec3& to_mm) const;

    /// All hits, ascending by parameter, then triangle. A hit exactly on an edge is reported for one or both of its
    /// triangles. `hits` is cleared first and can be used again, which saves the allocation.
    void all_hits(const Vec3& from_mm, const Vec3& to_mm, std::vector<SegmentHit>& hits) const;

    /// How many times the surface winds round the point: 1 inside and 0 outside a closed outward surface, 0 in a
    /// hollow, something between near the holes of an open one (Jacobson et al. 2013). Far parts of the surface are
    /// summed as dipoles (Barill et al. 2018) with an error below about 0.01.
    [[nodiscard]] double winding_number(const Vec3& point_mm) const;

    /// Whether the winding number is above one half. For a closed surface by counting the crossings of a ray, which is
    /// exact and faster.
    [[nodiscard]] bool inside(const Vec3& point_mm) const;

    /// Distance to the surface, negative where `inside`.
    [[nodiscard]] double signed_distance_mm(const Vec3& point_mm) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
