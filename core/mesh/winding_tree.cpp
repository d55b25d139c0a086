#include "core/mesh/winding_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace fretwork {
namespace {

constexpr std::uint32_t kLeaf = 8;
constexpr double kFar = 2.5;

/// Spreads the low 21 bits so that two zero bits follow each.
std::uint64_t spread(std::uint64_t x) {
    x &= 0x1fffff;
    x = (x | x << 32) & 0x1f00000000ffffULL;
    x = (x | x << 16) & 0x1f0000ff0000ffULL;
    x = (x | x << 8) & 0x100f00f00f00f00fULL;
    x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
    return (x | x << 2) & 0x1249249249249249ULL;
}

/// Solid angle of a triangle over 4 pi (van Oosterom and Strackee 1983).
double solid_angle_share(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    const double volume = a.dot(b.cross(c));
    const double below = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
    return volume == 0.0 && below == 0.0 ? 0.0 : std::atan2(volume, below) / (2.0 * std::numbers::pi);
}

}  // namespace

WindingTree::WindingTree(const TriangleMesh& mesh) {
    Vec3 low = mesh.positions_mm[mesh.triangles[0][0]], high = low;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) {
            low = low.cwiseMin(mesh.positions_mm[v]);
            high = high.cwiseMax(mesh.positions_mm[v]);
        }
    const double step = std::max((high - low).maxCoeff(), 1e-300) / 0x1fffff;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(mesh.triangles.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const Vec3 middle = (mesh.positions_mm[t[0]] + mesh.positions_mm[t[1]] + mesh.positions_mm[t[2]]) / 3.0;
        std::uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double cell = std::clamp((middle[axis] - low[axis]) / step, 0.0, double{0x1fffff});
            key |= spread(static_cast<std::uint64_t>(cell)) << axis;
        }
        order[i] = {key, i};
    }
    std::sort(order.begin(), order.end());
    triangles_.reserve(order.size());
    for (const auto& [key, i] : order) {
        const Triangle& t = mesh.triangles[i];
        triangles_.push_back({mesh.positions_mm[t[0]], mesh.positions_mm[t[1]], mesh.positions_mm[t[2]]});
    }
    groups_.reserve(order.size() / 2);
    build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void WindingTree::build(std::uint32_t begin, std::uint32_t end) {
    const std::size_t self = groups_.size();
    groups_.push_back(summary(begin, end));
    if (end - begin > kLeaf) {
        const std::uint32_t middle = begin + (end - begin) / 2;
        build(begin, middle);
        build(middle, end);
    }
    groups_[self].next = static_cast<std::uint32_t>(groups_.size());
}

WindingTree::Group WindingTree::summary(std::uint32_t begin, std::uint32_t end) const {
    Group g{Vec3::Zero(), Vec3::Zero(), Eigen::Matrix3d::Zero(), 0.0, begin, end, 0};
    double weight = 0.0;
    Vec3 low = triangles_[begin].a, high = low;
    for (std::uint32_t i = begin; i < end; ++i) {
        const Corners& t = triangles_[i];
        const double area = 0.5 * (t.b - t.a).cross(t.c - t.a).norm();
        g.center += area * (t.a + t.b + t.c) / 3.0;
        weight += area;
        low = low.cwiseMin(t.a).cwiseMin(t.b).cwiseMin(t.c);
        high = high.cwiseMax(t.a).cwiseMax(t.b).cwiseMax(t.c);
    }
    g.center = weight > 0.0 ? Vec3(g.center / weight) : Vec3(0.5 * (low + high));
    for (std::uint32_t i = begin; i < end; ++i) {
        const Corners& t = triangles_[i];
        const Vec3 area = 0.5 * (t.b - t.a).cross(t.c - t.a);
        g.area += area;
        g.moment += ((t.a + t.b + t.c) / 3.0 - g.center) * area.transpose();
        for (const Vec3* corner : {&t.a, &t.b, &t.c}) g.radius = std::max(g.radius, (*corner - g.center).norm());
    }
    return g;
}

double WindingTree::at(const Vec3& point_mm) const {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < groups_.size();) {
        const Group& g = groups_[i];
        const Vec3 r = g.center - point_mm;
        const double distance2 = r.squaredNorm();
        if (distance2 > kFar * kFar * g.radius * g.radius) {
            // Dipole r.n / |r|^3 and its gradient contracted with the first moments.
            const double inverse = 1.0 / std::sqrt(distance2), inverse3 = inverse * inverse * inverse;
            sum += (g.area.dot(r) + g.moment.trace() - 3.0 * inverse * inverse * r.dot(g.moment * r)) * inverse3 /
                   (4.0 * std::numbers::pi);
            i = g.next;
        } else if (g.end - g.begin <= kLeaf) {
            for (std::uint32_t t = g.begin; t < g.end; ++t)
                sum += solid_angle_share(triangles_[t].a - point_mm, triangles_[t].b - point_mm,
                                         triangles_[t].c - point_mm);
            i = g.next;
        } else {
            ++i;
        }
    }
    return sum;
}

}  // namespace fretwork
