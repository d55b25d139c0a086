// Generalised winding number of any triangle soup.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// Sums the solid angles of \cite jacobson2013robust: near triangles exactly, far groups as the dipole and the first
/// moments of \cite barill2018fast. Groups halve along a space-filling curve; a group is far when the point is more
/// than `kFar` of its radii away. Error below 0.002 in the tests' worst case; cost grows with the logarithm of the
/// size.
class WindingTree {
  public:
    explicit WindingTree(const TriangleMesh& mesh);
    [[nodiscard]] double at(const Vec3& point_mm) const;

  private:
    struct Corners {
        Vec3 a, b, c;
    };
    struct Group {
        Vec3 center;
        Vec3 area;               ///< sum of area vectors
        Eigen::Matrix3d moment;  ///< sum of (centroid - center) * area vector^T
        double radius;
        std::uint32_t begin, end;
        std::uint32_t next;  ///< the group after this one's descendants
    };
    void build(std::uint32_t begin, std::uint32_t end);
    [[nodiscard]] Group summary(std::uint32_t begin, std::uint32_t end) const;

    std::vector<Corners> triangles_;  ///< along the curve
    std::vector<Group> groups_;       ///< depth first
};

}  // namespace fretwork
