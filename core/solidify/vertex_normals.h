// Which way a surface faces at its vertices.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "core/mesh/triangle_mesh.h"

namespace fretwork {

inline Vec3f unit_normal(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3& a = mesh.positions_mm[t[0]];
    return (mesh.positions_mm[t[1]] - a).cross(mesh.positions_mm[t[2]] - a).normalized().cast<float>();
}

/// Sum of the unit normals of the triangles at each vertex that is `wanted`, the rest zero.
inline std::vector<Vec3f> normal_sums(const TriangleMesh& mesh, const std::vector<std::uint8_t>& wanted) {
    std::vector<Vec3f> sums(mesh.positions_mm.size(), Vec3f::Zero());
    for (const Triangle& t : mesh.triangles) {
        if (wanted[t[0]] == 0 && wanted[t[1]] == 0 && wanted[t[2]] == 0) continue;
        const Vec3f n = unit_normal(mesh, t);
        for (const std::uint32_t v : t)
            if (wanted[v] != 0) sums[v] += n;
    }
    return sums;
}

/// Whether a triangle faces against the surface around one of its corners, as the two sides of a fold do.
inline bool folded(const TriangleMesh& mesh, const Triangle& t, const std::vector<Vec3f>& sums) {
    constexpr float kAgainst = -0.1F;
    const Vec3f n = unit_normal(mesh, t);
    for (const std::uint32_t v : t)
        if (n.dot(sums[v]) < kAgainst * sums[v].norm()) return true;
    return false;
}

}  // namespace fretwork
