#include "core/mesh/spread_points.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

double area_of(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3& a = mesh.positions_mm[t[0]];
    return 0.5 * (mesh.positions_mm[t[1]] - a).cross(mesh.positions_mm[t[2]] - a).norm();
}

}  // namespace

double area_mm2(const TriangleMesh& mesh) {
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) area += area_of(mesh, t);
    return area;
}

std::vector<SpreadPoint> spread_points(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed,
                                       RandomStream stream) {
    std::vector<double> area_up_to;
    area_up_to.reserve(mesh.triangles.size());
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) area_up_to.push_back(area += area_of(mesh, t));
    std::vector<SpreadPoint> points(count);
    parallel_for(count, 4096, [&](std::size_t i) {
        const auto random = [&](std::uint32_t draw) { return unit_interval(counter_random(seed, stream, 0, i, draw)); };
        const double at = area * (static_cast<double>(i) + random(0)) / static_cast<double>(count);
        const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, at);
        const auto index = static_cast<std::uint32_t>(found - area_up_to.begin());
        const Triangle& t = mesh.triangles[index];
        double u = random(1), v = random(2);
        if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
        const Vec3& a = mesh.positions_mm[t[0]];
        points[i] = {a + u * (mesh.positions_mm[t[1]] - a) + v * (mesh.positions_mm[t[2]] - a), index};
    });
    return points;
}

}  // namespace fretwork
