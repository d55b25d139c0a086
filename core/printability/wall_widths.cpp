#include "core/printability/wall_widths.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>

#include "core/base/parallel.h"
#include "core/mesh/spread_points.h"

namespace fretwork {
namespace {

constexpr std::size_t kMostPoints = 60'000;
constexpr std::uint64_t kSeed = 1;
constexpr double kCosFacing = -0.866;   // of the angle between the normals, 150 degrees
constexpr double kOffTheWallMm = 1e-5;  // so that a way does not end where it starts

Vec3 normal_of(const TriangleMesh& mesh, std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const Vec3 &a = mesh.positions_mm[t[0]], &b = mesh.positions_mm[t[1]], &c = mesh.positions_mm[t[2]];
    return (b - a).cross(c - a).normalized();
}

std::size_t count_for(const TriangleMesh& mesh, double spacing_mm) {
    const double wanted = area_mm2(mesh) / (spacing_mm * spacing_mm);
    return static_cast<std::size_t>(std::clamp(wanted, 1.0, static_cast<double>(kMostPoints)));
}

}  // namespace

std::vector<WallWidth> wall_widths(const TriangleMesh& mesh, const SurfaceTree& tree, WallSide side, double limit_mm,
                                   const RunControl& run) {
    const auto points = spread_points(mesh, count_for(mesh, limit_mm / 4), kSeed, RandomStream::kPrintability);
    std::vector<WallWidth> widths(points.size());
    parallel_for(points.size(), 256, [&](std::size_t i) {
        run.throw_if_stopped();
        const Vec3& at = points[i].at_mm;
        const Vec3 normal = normal_of(mesh, points[i].triangle);
        const Vec3 into = side == WallSide::kGap ? normal : Vec3(-normal);
        widths[i] = {at, limit_mm};
        const auto hit = tree.first_hit(at + kOffTheWallMm * into, at + limit_mm * into);
        if (hit && normal_of(mesh, hit->triangle).dot(normal) < kCosFacing)
            widths[i].width_mm = hit->parameter * limit_mm;
    });
    return widths;
}

}  // namespace fretwork
