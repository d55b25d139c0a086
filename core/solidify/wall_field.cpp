#include "core/solidify/wall_field.h"

#include <Eigen/Geometry>
#include <cmath>

#include "core/mesh/triangle_math.h"

namespace fretwork {
WallField::WallField(const TriangleMesh& mesh, const SurfaceTree& tree, const PatternField& pattern, double voxel_mm,
                     const WallLimits& limits)
    : mesh_(mesh),
      tree_(tree),
      pattern_(pattern),
      voxel_mm_(voxel_mm),
      limits_(limits),
      normals_(mesh.triangles.size()) {
    const double depth =
        limits.signed_distance ? std::max(std::abs(limits.lower), std::abs(limits.upper)) : limits.upper;
    reach_voxels_ = depth + longest_edge() + 0.05;
    for (std::size_t t = 0; t < normals_.size(); ++t) {
        const auto& [a, b, c] = mesh.triangles[t];
        const Vec3& p = mesh.positions_mm[a];
        normals_[t] = (mesh.positions_mm[b] - p).cross(mesh.positions_mm[c] - p).normalized();
    }
}

Vec3 WallField::closest_on(std::uint32_t triangle, const Vec3& p) const {
    const auto& [a, b, c] = mesh_.triangles[triangle];
    return closest_on_triangle(p, mesh_.positions_mm[a], mesh_.positions_mm[b], mesh_.positions_mm[c]);
}

WallSample WallField::sample(const Vec3& point_mm, double sign, std::uint32_t hint, double reach_voxels) const {
    WallSample s = sample_slab(point_mm, sign, hint, reach_voxels, 0.0);
    if (s.found) s.pattern = pattern_at(s.closest_mm, s.triangle);
    return s;
}

WallSample WallField::sample_slab(const Vec3& point_mm, double sign, std::uint32_t hint, double reach_voxels,
                                  double pattern) const {
    WallSample s;
    const double reach = reach_voxels > 0.0 ? reach_voxels : reach_voxels_ + 1.0;
    const ClosestPoint closest = tree_.closest(point_mm, reach * voxel_mm_, hint);
    if (!closest.found()) return s;
    s.found = true;
    s.closest_mm = closest.point_mm;
    s.triangle = closest.triangle;
    if (!limits_.signed_distance) sign = 1.0;
    if (sign == 0.0) sign = normals_[s.triangle].dot(point_mm - s.closest_mm) < 0.0 ? -1.0 : 1.0;
    s.phi = std::copysign(closest.distance_mm / voxel_mm_, sign);
    s.pattern = pattern;
    return s;
}

}  // namespace fretwork
