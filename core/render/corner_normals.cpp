#include "core/render/corner_normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <numeric>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

/// Number of the place of each vertex; vertices at equal positions share one.
std::vector<std::uint32_t> places(const std::vector<Vec3>& positions, std::size_t& count) {
    std::vector<std::uint32_t> order(positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto key = [&](std::uint32_t v) {
        const Vec3& p = positions[v];
        return std::array<double, 3>{p.x(), p.y(), p.z()};
    };
    std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
    std::vector<std::uint32_t> place(positions.size());
    count = 0;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && key(order[i - 1]) != key(order[i])) ++count;
        place[order[i]] = static_cast<std::uint32_t>(count);
    }
    if (!order.empty()) ++count;
    return place;
}

float corner_angle(const TriangleMesh& mesh, const Triangle& t, std::size_t corner) {
    const Vec3& at = mesh.positions_mm[t[corner]];
    const Vec3 a = mesh.positions_mm[t[(corner + 1) % 3]] - at, b = mesh.positions_mm[t[(corner + 2) % 3]] - at;
    return static_cast<float>(std::atan2(a.cross(b).norm(), a.dot(b)));
}

}  // namespace

std::vector<std::array<Vec3f, 3>> corner_normals(const TriangleMesh& mesh, double crease_angle_deg) {
    const std::size_t triangles = mesh.triangles.size();
    std::vector<Vec3f> facet(triangles);
    std::vector<std::array<float, 3>> angle(triangles);
    parallel_for(triangles, 4096, [&](std::size_t i) {
        const Triangle& t = mesh.triangles[i];
        const Vec3& a = mesh.positions_mm[t[0]];
        const Vec3 n = (mesh.positions_mm[t[1]] - a).cross(mesh.positions_mm[t[2]] - a);
        const double length = n.norm();
        facet[i] = length > 0 ? Vec3f((n / length).cast<float>()) : Vec3f::UnitZ();
        for (std::size_t k = 0; k < 3; ++k) angle[i][k] = length > 0 ? corner_angle(mesh, t, k) : 0.0f;
    });

    std::size_t place_count = 0;
    const std::vector<std::uint32_t> place = places(mesh.positions_mm, place_count);
    // Corners at each place, in order of triangles.
    std::vector<std::size_t> begin(place_count + 1, 0);
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) ++begin[place[v] + 1];
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<std::uint32_t> corners(3 * triangles);
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (std::size_t i = 0; i < triangles; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            corners[next[place[mesh.triangles[i][k]]]++] = static_cast<std::uint32_t>(3 * i + k);

    const auto least_cosine = static_cast<float>(std::cos(crease_angle_deg * std::numbers::pi / 180));
    std::vector<std::array<Vec3f, 3>> normals(triangles);
    parallel_for(triangles, 4096, [&](std::size_t i) {
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t p = place[mesh.triangles[i][k]];
            Vec3f sum = angle[i][k] * facet[i];
            for (std::size_t c = begin[p]; c < begin[p + 1]; ++c) {
                const std::uint32_t other = corners[c] / 3;
                if (other != i && facet[other].dot(facet[i]) > least_cosine)
                    sum += angle[other][corners[c] % 3] * facet[other];
            }
            const float length = sum.norm();
            normals[i][k] = length > 0 ? Vec3f(sum / length) : facet[i];
        }
    });
    return normals;
}

}  // namespace fretwork
