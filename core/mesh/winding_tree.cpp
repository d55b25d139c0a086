#include "core/mesh/winding_tree.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace fretwork {
namespace {

constexpr std::uint32_t kLeaf = 8;
constexpr double kFar = 2.0;

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

WindingTree::WindingTree(std::vector<Corners> triangles) {
    Vec3 low = triangles[0].a, high = low;
    for (const Corners& t : triangles) {
        low = low.cwiseMin(t.a).cwiseMin(t.b).cwiseMin(t.c);
        high = high.cwiseMax(t.a).cwiseMax(t.b).cwiseMax(t.c);
    }
    const double step = std::max((high - low).maxCoeff(), 1e-300) / 0x1fffff;
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order(triangles.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        const Vec3 middle = (triangles[i].a + triangles[i].b + triangles[i].c) / 3.0;
        std::uint64_t key = 0;
        for (int axis = 0; axis < 3; ++axis) {
            const double cell = std::clamp((middle[axis] - low[axis]) / step, 0.0, double{0x1fffff});
            key |= spread(static_cast<std::uint64_t>(cell)) << axis;
        }
        order[i] = {key, i};
    }
    std::sort(order.begin(), order.end());
    triangles_.reserve(order.size());
    for (const auto& [key, i] : order) triangles_.push_back(triangles[i]);
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
    Group g{Vec3::Zero(), Vec3::Zero(), Eigen::Matrix3d::Zero(), Vec3::Zero(), {}, 0.0, begin, end, 0};
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
        const Vec3 share = (t.b - t.a).cross(t.c - t.a) / 6.0;
        // The middles of the sides integrate squares over a triangle exactly.
        for (const Vec3& m : {Vec3(0.5 * (t.a + t.b)), Vec3(0.5 * (t.b + t.c)), Vec3(0.5 * (t.c + t.a))})
            add_moments(g, share, m - g.center);
        for (const Vec3* corner : {&t.a, &t.b, &t.c}) g.radius = std::max(g.radius, (*corner - g.center).norm());
    }
    return g;
}

void WindingTree::add_moments(Group& g, const Vec3& n, const Vec3& d) {
    g.area += n;
    g.moment += d * n.transpose();
    g.squared += 2.0 * n.dot(d) * d + d.squaredNorm() * n;
    // Coefficients of x^3, y^3, z^3, x^2 y, x^2 z, y^2 x, y^2 z, z^2 x, z^2 y, x y z.
    std::size_t k = 0;
    for (int i = 0; i < 3; ++i) g.cubic[k++] += n[i] * d[i] * d[i];
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            if (i != j) g.cubic[k++] += 2.0 * n[i] * d[i] * d[j] + n[j] * d[i] * d[i];
    g.cubic[k] += 2.0 * (n[0] * d[1] * d[2] + n[1] * d[0] * d[2] + n[2] * d[0] * d[1]);
}

double WindingTree::from_afar(const Group& g, const Vec3& r) {
    const double inverse2 = 1.0 / r.squaredNorm();
    const double xx = r[0] * r[0], yy = r[1] * r[1], zz = r[2] * r[2];
    const double cubic = g.cubic[0] * xx * r[0] + g.cubic[1] * yy * r[1] + g.cubic[2] * zz * r[2] +
                         xx * (g.cubic[3] * r[1] + g.cubic[4] * r[2]) + yy * (g.cubic[5] * r[0] + g.cubic[6] * r[2]) +
                         zz * (g.cubic[7] * r[0] + g.cubic[8] * r[1]) + g.cubic[9] * r[0] * r[1] * r[2];
    const double first = g.area.dot(r);
    const double second = g.moment.trace() - 3.0 * inverse2 * r.dot(g.moment * r);
    const double third = 1.5 * inverse2 * (5.0 * inverse2 * cubic - g.squared.dot(r));
    return (first + second + third) * inverse2 * std::sqrt(inverse2) / (4.0 * std::numbers::pi);
}

double WindingTree::at(const Vec3& point_mm) const {
    double sum = 0.0;
    for (std::uint32_t i = 0; i < groups_.size();) {
        const Group& g = groups_[i];
        const Vec3 r = g.center - point_mm;
        if (r.squaredNorm() > kFar * kFar * g.radius * g.radius) {
            sum += from_afar(g, r);
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
