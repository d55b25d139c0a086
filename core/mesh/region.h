// Parts of the surface that the user names: to keep, to carve, to load, to hold.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork {

struct BoxRegion {
    Vec3 min_mm, max_mm;
};
struct SphereRegion {
    Vec3 center_mm;
    double radius_mm;
};
struct CylinderRegion {
    Vec3 from_mm, to_mm;
    double radius_mm;
};  ///< flat ends
struct HalfSpaceRegion {
    Vec3 point_mm, outward;
};  ///< inside where (p - point).outward < 0
struct PlaneBandRegion {
    Vec3 point_mm, normal;
    double half_width_mm;
};
struct SharpEdgeRegion {
    double min_angle_deg;
    double half_width_mm;
};  ///< around edges folded by more than the angle
struct OpenBorderRegion {
    double half_width_mm;
};  ///< around edges with one triangle
struct TriangleSetRegion {
    std::vector<std::uint32_t> triangles;
};
/// Faces of a CAD model and parts of a file, by name. Turned into a TriangleSetRegion before it is asked.
struct NamedRegion {
    std::vector<std::string> names;
};
struct LowestRegion {
    double share;
};  ///< lowest part of the height (z), share in (0, 1]
struct EverywhereRegion {};
/// What a closed surface encloses, its border included: a face of the model that lies on it is inside.
/// In the coordinates of the model's file until it is asked, as triangle sets are.
struct VolumeRegion {
    TriangleMesh surface;
};

struct Region {
    std::string name;
    std::variant<BoxRegion, SphereRegion, CylinderRegion, HalfSpaceRegion, PlaneBandRegion, SharpEdgeRegion,
                 OpenBorderRegion, TriangleSetRegion, NamedRegion, LowestRegion, EverywhereRegion, VolumeRegion>
        shape;
};

/// Triangles of a model that have a name: a face of a CAD model, a part of a file.
struct NamedTriangles {
    std::string name;
    std::uint32_t first_triangle = 0;
    std::uint32_t triangle_count = 0;
};

/// Regions prepared against one mesh for many queries. Safe to query from several threads.
class RegionField {
  public:
    /// \param outside_of  if there are any, everything outside of all of them belongs to the union too: what
    ///                    the user leaves when only these may be carved
    /// \throws InvalidSetting  a radius or width that is not positive, a zero normal, an empty box, a
    ///                         triangle past the end, a volume that is not closed, a region that meets no part of the
    ///                         surface (by name).
    RegionField(const TriangleMesh& mesh, const std::vector<Region>& regions,
                const std::vector<Region>& outside_of = {});
    ~RegionField();
    RegionField(RegionField&&) noexcept;
    RegionField& operator=(RegionField&&) noexcept;

    [[nodiscard]] bool empty() const;

    /// Distance from a surface point to the border of the union of the regions, negative inside; mm.
    /// Exact for single shapes away from edges and a lower bound in size elsewhere. +infinity without regions.
    /// \param triangle  the triangle the point lies on
    [[nodiscard]] double signed_distance_mm(const Vec3& point_mm, std::uint32_t triangle) const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
