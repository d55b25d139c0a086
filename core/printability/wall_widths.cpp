#include "core/printability/wall_widths.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "core/base/counter_random.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kMostPoints = 60'000;
constexpr std::uint64_t kSeed = 1;
constexpr double kCosFacing = -0.866;   // of the angle between the normals, 150 degrees
constexpr double kOffTheWallMm = 1e-5;  // so that a way does not end where it starts

struct SurfacePoint {
    Vec3 at_mm, normal;
};

Vec3 normal_of(const TriangleMesh& mesh, std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const Vec3 &a = mesh.positions_mm[t[0]], &b = mesh.positions_mm[t[1]], &c = mesh.positions_mm[t[2]];
    return (b - a).cross(c - a).normalized();
}

/// Points that each stand for the same area, drawn one from each equal share of it.
std::vector<SurfacePoint> spread_points(const TriangleMesh& mesh, double spacing_mm) {
    std::vector<double> up_to;
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 &a = mesh.positions_mm[t[0]], &b = mesh.positions_mm[t[1]], &c = mesh.positions_mm[t[2]];
        up_to.push_back(area += 0.5 * (b - a).cross(c - a).norm());
    }
    const auto count =
        static_cast<std::size_t>(std::clamp(area / (spacing_mm * spacing_mm), 1.0, static_cast<double>(kMostPoints)));
    std::vector<SurfacePoint> points;
    for (std::size_t i = 0; i < count; ++i) {
        const auto random = [&](std::uint32_t k) {
            return unit_interval(counter_random(kSeed, RandomStream::kPrintability, 0, i, k));
        };
        const double wanted = (static_cast<double>(i) + random(0)) / static_cast<double>(count) * area;
        const auto found = std::ranges::upper_bound(up_to, wanted);
        const auto index = std::min<std::size_t>(static_cast<std::size_t>(found - up_to.begin()), up_to.size() - 1);
        const Triangle& t = mesh.triangles[index];
        const Vec3 &a = mesh.positions_mm[t[0]], &b = mesh.positions_mm[t[1]], &c = mesh.positions_mm[t[2]];
        const double root = std::sqrt(random(1)), along = random(2);
        points.push_back(
            {(1.0 - root) * a + root * ((1.0 - along) * b + along * c), (b - a).cross(c - a).normalized()});
    }
    return points;
}

}  // namespace

std::vector<WallWidth> wall_widths(const TriangleMesh& mesh, const SurfaceTree& tree, WallSide side, double limit_mm,
                                   const RunControl& run) {
    const std::vector<SurfacePoint> points = spread_points(mesh, limit_mm / 4);
    std::vector<WallWidth> widths(points.size());
    parallel_for(points.size(), 256, [&](std::size_t i) {
        run.throw_if_stopped();
        const SurfacePoint& p = points[i];
        const Vec3 into = side == WallSide::kGap ? p.normal : Vec3(-p.normal);
        widths[i] = {p.at_mm, limit_mm};
        const auto hit = tree.first_hit(p.at_mm + kOffTheWallMm * into, p.at_mm + limit_mm * into);
        if (hit && normal_of(mesh, hit->triangle).dot(p.normal) < kCosFacing)
            widths[i].width_mm = hit->parameter * limit_mm;
    });
    return widths;
}

}  // namespace fretwork
