// Does a triangle touch a convex region? By clipping the triangle with the planes that bound the region.
#include <algorithm>
#include <vector>

#include "core/mesh/region_shapes.h"
#include "core/mesh/triangle_math.h"

namespace fretwork::regions {
namespace {

using Polygon = std::vector<Vec3>;

/// The part where (p - point).outward <= 0 (Sutherland and Hodgman).
Polygon clipped(const Polygon& polygon, const Vec3& point, const Vec3& outward) {
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double at_p = (p - point).dot(outward), at_q = (q - point).dot(outward);
        if (at_p <= 0.0) kept.push_back(p);
        if ((at_p < 0.0 && at_q > 0.0) || (at_p > 0.0 && at_q < 0.0))
            kept.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
    return kept;
}

}  // namespace

bool meets(const BoxRegion& box, const Vec3& a, const Vec3& b, const Vec3& c) {
    Polygon polygon = {a, b, c};
    for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) {
        polygon = clipped(polygon, box.max_mm, Vec3::Unit(axis));
        polygon = clipped(polygon, box.min_mm, -Vec3::Unit(axis));
    }
    return !polygon.empty();
}

bool meets(const SphereRegion& sphere, const Vec3& a, const Vec3& b, const Vec3& c) {
    return (closest_on_triangle(sphere.center_mm, a, b, c) - sphere.center_mm).norm() <= sphere.radius_mm;
}

bool meets(const CylinderRegion& cylinder, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 axis = (cylinder.to_mm - cylinder.from_mm).normalized();
    Polygon polygon = clipped({a, b, c}, cylinder.to_mm, axis);
    polygon = clipped(polygon, cylinder.from_mm, -axis);
    // What is left of the triangle between the ends, seen along the axis: a flat polygon and a disc.
    for (Vec3& p : polygon) p -= axis.dot(p - cylinder.from_mm) * axis;
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i) {
        const Vec3 p = closest_on_triangle(cylinder.from_mm, polygon[0], polygon[i], polygon[i + 1]);
        if ((p - cylinder.from_mm).norm() <= cylinder.radius_mm) return true;
    }
    return std::any_of(polygon.begin(), polygon.end(),
                       [&](const Vec3& p) { return (p - cylinder.from_mm).norm() <= cylinder.radius_mm; });
}

bool meets(const HalfSpaceRegion& half_space, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto below = [&](const Vec3& p) { return (p - half_space.point_mm).dot(half_space.outward) <= 0.0; };
    return below(a) || below(b) || below(c);
}

bool meets(const PlaneBandRegion& band, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 normal = band.normal.normalized();
    const double da = (a - band.point_mm).dot(normal), db = (b - band.point_mm).dot(normal),
                 dc = (c - band.point_mm).dot(normal);
    return std::min({da, db, dc}) <= band.half_width_mm && std::max({da, db, dc}) >= -band.half_width_mm;
}

}  // namespace fretwork::regions
