#include "core/mesh/check_mesh.h"

#include <Eigen/Geometry>
#include <limits>
#include <string>

#include "core/base/error.h"

namespace fretwork {
namespace {

constexpr double kLargestCoordinate_mm = 1e9;

[[noreturn]] void refuse(const char* caller, const std::string& what) {
    throw InvalidInput(std::string(caller) + ": " + what);
}

bool has_area(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3& a = mesh.positions_mm[t[0]];
    return (mesh.positions_mm[t[1]] - a).cross(mesh.positions_mm[t[2]] - a).squaredNorm() > 0.0;
}

}  // namespace

void check_mesh(const TriangleMesh& mesh, const char* caller, ZeroArea zero_area) {
    constexpr std::size_t most = std::numeric_limits<std::uint32_t>::max() / 3 - 1;  // half-edges are counted too
    if (mesh.triangles.empty()) refuse(caller, "the mesh has no triangles; at least one is needed");
    if (mesh.triangles.size() > most || mesh.positions_mm.size() > most)
        refuse(caller, "the mesh has " + std::to_string(mesh.positions_mm.size()) + " vertices and " +
                           std::to_string(mesh.triangles.size()) + " triangles; no more than " + std::to_string(most) +
                           " of each can be handled");
    for (std::size_t v = 0; v < mesh.positions_mm.size(); ++v)
        for (int axis = 0; axis < 3; ++axis) {
            const double x = mesh.positions_mm[v][axis];
            if (!(std::abs(x) <= kLargestCoordinate_mm))
                refuse(caller, "coordinate " + std::string(1, "xyz"[axis]) + " of vertex " + std::to_string(v) +
                                   " is " + std::to_string(x) + "; expected a number within 1e9 mm of the origin");
        }
    bool any_area = false;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (const std::uint32_t v : mesh.triangles[t])
            if (v >= mesh.positions_mm.size())
                refuse(caller, "triangle " + std::to_string(t) + " names vertex " + std::to_string(v) +
                                   ", but the mesh has " + std::to_string(mesh.positions_mm.size()) + " vertices");
        any_area = any_area || has_area(mesh, mesh.triangles[t]);
    }
    if (zero_area == ZeroArea::kRefused && !any_area)
        refuse(caller, "all " + std::to_string(mesh.triangles.size()) + " triangles have zero area");
}

}  // namespace fretwork
