// Signed distances of the shapes of region.h, and whether they meet a surface. Internal to this folder.
#pragma once

#include <memory>

#include "core/mesh/region.h"

namespace fretwork::regions {

/// A shape made ready against one mesh.
class Shape {
  public:
    virtual ~Shape() = default;
    /// Negative inside; mm.
    [[nodiscard]] virtual double signed_distance_mm(const Vec3& point_mm, std::uint32_t triangle) const = 0;
};

/// \throws InvalidSetting  see RegionField.
std::unique_ptr<Shape> prepare(const TriangleMesh& mesh, const Region& region);

/// Whether any part of the triangle a, b, c lies in the closed shape. Exact to rounding.
bool meets(const BoxRegion& box, const Vec3& a, const Vec3& b, const Vec3& c);
bool meets(const SphereRegion& sphere, const Vec3& a, const Vec3& b, const Vec3& c);
bool meets(const CylinderRegion& cylinder, const Vec3& a, const Vec3& b, const Vec3& c);
bool meets(const HalfSpaceRegion& half_space, const Vec3& a, const Vec3& b, const Vec3& c);
bool meets(const PlaneBandRegion& band, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace fretwork::regions
