#include "core/mesh/mesh_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/check_mesh.h"
#include "core/mesh/closest_point.h"

namespace fretwork {
namespace {

/// Points spread over the surface: one in each of `count` strips of equal area, at a random place.
std::vector<Vec3> sample(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed) {
    std::vector<double> area_up_to;
    area_up_to.reserve(mesh.triangles.size());
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions_mm[t[0]];
        area += 0.5 * (mesh.positions_mm[t[1]] - a).cross(mesh.positions_mm[t[2]] - a).norm();
        area_up_to.push_back(area);
    }
    std::vector<Vec3> points(count);
    parallel_for(count, 4096, [&](std::size_t i) {
        const auto random = [&](std::uint32_t draw) {
            return unit_interval(counter_random(seed, RandomStream::kMeshDistance, 0, i, draw));
        };
        const double at = area * (static_cast<double>(i) + random(0)) / static_cast<double>(count);
        const auto found = std::upper_bound(area_up_to.begin(), area_up_to.end() - 1, at);
        const Triangle& t = mesh.triangles[static_cast<std::size_t>(found - area_up_to.begin())];
        double u = random(1), v = random(2);
        if (u + v > 1.0) u = 1.0 - u, v = 1.0 - v;
        const Vec3& a = mesh.positions_mm[t[0]];
        points[i] = a + u * (mesh.positions_mm[t[1]] - a) + v * (mesh.positions_mm[t[2]] - a);
    });
    return points;
}

OneSidedDistance one_sided(const TriangleMesh& from, const TriangleMesh& to, const MeshDistanceSettings& settings,
                           const RunControl& run) {
    const SurfaceTree tree(to, run);
    std::vector<Vec3> points = sample(from, settings.samples, settings.seed);
    std::vector<std::uint8_t> used(from.positions_mm.size(), 0);
    for (const Triangle& t : from.triangles)
        for (const std::uint32_t v : t)
            if (used[v] == 0) used[v] = 1, points.push_back(from.positions_mm[v]);
    const std::vector<ClosestPoint> answers = tree.closest(points, std::numeric_limits<double>::infinity(), run);
    OneSidedDistance result;
    for (std::size_t i = 0; i < answers.size(); ++i) {
        const double d = answers[i].distance_mm;
        result.max_mm = std::max(result.max_mm, d);
        if (i >= settings.samples) continue;
        result.mean_mm += d;
        result.root_mean_square_mm += d * d;
    }
    result.mean_mm /= static_cast<double>(settings.samples);
    result.root_mean_square_mm = std::sqrt(result.root_mean_square_mm / static_cast<double>(settings.samples));
    return result;
}

}  // namespace

MeshDistance mesh_distance(const TriangleMesh& first, const TriangleMesh& second, const MeshDistanceSettings& settings,
                           const RunControl& run) {
    if (settings.samples == 0) throw InvalidSetting("mesh distance: samples is 0; expected at least 1");
    check_mesh(first, "mesh distance, first mesh");
    check_mesh(second, "mesh distance, second mesh");
    return {one_sided(first, second, settings, run), one_sided(second, first, settings, run)};
}

}  // namespace fretwork
