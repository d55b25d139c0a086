#include "formats/polygon_fan.h"

#include <Eigen/Geometry>

namespace fretwork {
namespace {

/// Polygons with more corners are not cut ear by ear, so that a hostile file cannot make the cubic
/// worst case of that method matter.
constexpr std::size_t kMostCornersToCut = 64;

/// Newell's normal: twice the polygon's vector area, sound for corners that are not quite coplanar.
Vec3 vector_area(const std::vector<Vec3>& positions, std::span<const std::uint32_t> corners) {
    Vec3 sum = Vec3::Zero();
    const Vec3& first = positions[corners[0]];
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        sum += (positions[corners[i]] - first).cross(positions[corners[i + 1]] - first);
    return sum;
}

double turn(const std::vector<Vec3>& positions, std::uint32_t a, std::uint32_t b, std::uint32_t c, const Vec3& normal) {
    return (positions[b] - positions[a]).cross(positions[c] - positions[b]).dot(normal);
}

bool fan_is_sound(const std::vector<Vec3>& positions, std::span<const std::uint32_t> corners, const Vec3& normal) {
    for (std::size_t i = 1; i + 1 < corners.size(); ++i)
        if (turn(positions, corners[0], corners[i], corners[i + 1], normal) <= 0.0) return false;
    return true;
}

bool is_ear(const std::vector<Vec3>& positions, const std::vector<std::uint32_t>& ring, std::size_t i,
            const Vec3& normal) {
    const std::size_t n = ring.size();
    const std::uint32_t a = ring[(i + n - 1) % n], b = ring[i], c = ring[(i + 1) % n];
    if (turn(positions, a, b, c, normal) <= 0.0) return false;
    for (const std::uint32_t p : ring) {
        if (p == a || p == b || p == c) continue;
        if (turn(positions, a, b, p, normal) >= 0.0 && turn(positions, b, c, p, normal) >= 0.0 &&
            turn(positions, c, a, p, normal) >= 0.0)
            return false;
    }
    return true;
}

}  // namespace

void append_polygon(const std::vector<Vec3>& positions, std::span<const std::uint32_t> corners,
                    std::vector<Triangle>& triangles) {
    if (corners.size() == 3) {
        triangles.push_back({corners[0], corners[1], corners[2]});
        return;
    }
    std::vector<std::uint32_t> ring;
    ring.reserve(corners.size());
    for (const std::uint32_t corner : corners)
        if (ring.empty() || ring.back() != corner) ring.push_back(corner);
    while (ring.size() > 1 && ring.back() == ring.front()) ring.pop_back();
    if (ring.size() < 3) return;

    const Vec3 normal = vector_area(positions, ring);
    if (ring.size() <= kMostCornersToCut && !fan_is_sound(positions, ring, normal)) {
        // Ears are cut until none is left; what remains is convex, flat or twisted and becomes a fan.
        for (std::size_t i = 0, misses = 0; ring.size() > 3 && misses < ring.size();) {
            const std::size_t n = ring.size();
            i %= n;
            if (is_ear(positions, ring, i, normal)) {
                triangles.push_back({ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]});
                ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(i));
                misses = 0;
            } else {
                ++i;
                ++misses;
            }
        }
    }
    for (std::size_t i = 1; i + 1 < ring.size(); ++i) triangles.push_back({ring[0], ring[i], ring[i + 1]});
}

}  // namespace fretwork
