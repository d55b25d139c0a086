#include "core/mesh/sharp_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/mesh/check_mesh.h"
#include "core/mesh/edge_table.h"

namespace fretwork {
namespace {

Vec3 area_vector(const TriangleMesh& mesh, std::uint32_t t) {
    const Triangle& k = mesh.triangles[t];
    const Vec3& a = mesh.positions_mm[k[0]];
    return (mesh.positions_mm[k[1]] - a).cross(mesh.positions_mm[k[2]] - a);
}

/// Angle between the normals over an edge, as if both triangles were turned alike.
double fold_deg(const TriangleMesh& mesh, HalfEdge g, HalfEdge h) {
    const Vec3 n = area_vector(mesh, g / 3);
    Vec3 m = area_vector(mesh, h / 3);
    if (runs_up(mesh, g) == runs_up(mesh, h)) m = -m;
    // The arctangent keeps its digits near 0 and 180, where an arccosine loses half of them.
    return std::atan2(n.cross(m).norm(), n.dot(m)) * 180.0 / std::numbers::pi;
}

}  // namespace

std::vector<MeshEdge> sharp_edges(const TriangleMesh& mesh, double min_angle_deg) {
    if (!(min_angle_deg >= 0.0 && min_angle_deg <= 180.0))
        throw InvalidSetting("sharp edges: the angle is " + std::to_string(min_angle_deg) +
                             " degrees; expected 0 to 180");
    check_mesh(mesh, "sharp edges", ZeroArea::kAllowed);
    const EdgeTable edges(mesh);
    std::vector<MeshEdge> sharp;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto half_edges = edges.half_edges(e);
        double fold = 0.0;
        for (std::size_t i = 1; i < half_edges.size(); ++i)
            for (std::size_t j = 0; j < i; ++j) fold = std::max(fold, fold_deg(mesh, half_edges[j], half_edges[i]));
        if (fold > min_angle_deg || half_edges.size() > 2) sharp.push_back({edges.low(e), edges.high(e), fold});
    }
    return sharp;
}

std::vector<MeshEdge> border_edges(const TriangleMesh& mesh) {
    check_mesh(mesh, "border edges", ZeroArea::kAllowed);
    const EdgeTable edges(mesh);
    std::vector<MeshEdge> border;
    for (std::size_t e = 0; e < edges.size(); ++e)
        if (edges.half_edges(e).size() == 1) border.push_back({edges.low(e), edges.high(e), 0.0});
    return border;
}

}  // namespace fretwork
