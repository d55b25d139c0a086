#include "core/solidify/feature_point.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace fretwork {
namespace {

/// Facets folded by less than this leave less than a twentieth of a voxel of chamfer.
constexpr float kFoldCosine = 0.94F;  // 20 degrees

constexpr double kAccepted = 0.15;    // voxels off the faces
constexpr double kLongestMove = 0.8;  // voxels from the chord it replaces; farther, the planes say nothing
constexpr int kRounds = 4;

using Vec2d = Eigen::Vector2d;
using Mat2d = Eigen::Matrix2d;

/// The share of the way between two points, by their barycentric coordinates, after which the least falls below
/// `margin`.
template <class Bary>
double share_inside(const Bary& from, const Bary& to, double margin) {
    double share = 1.0;
    for (Eigen::Index k = 0; k < from.size(); ++k)
        if (to[k] < margin && to[k] < from[k]) share = std::min(share, (from[k] - margin) / (from[k] - to[k]));
    return std::max(share, 0.0);
}

/// Plane coordinates of one lattice triangle, in voxels from its first corner.
class TrianglePlane {
  public:
    TrianglePlane(const std::array<EdgeEnd, 3>& corner, double voxel_mm)
        : origin_(corner[0].position_mm), voxel_mm_(voxel_mm) {
        const Vec3 u = (corner[1].position_mm - origin_) / voxel_mm, v = (corner[2].position_mm - origin_) / voxel_mm;
        x_axis_ = u.normalized();
        y_axis_ = (v - v.dot(x_axis_) * x_axis_).normalized();
        sides_.col(0) = Vec2d(u.dot(x_axis_), 0.0);
        sides_.col(1) = Vec2d(v.dot(x_axis_), v.dot(y_axis_));
        inverse_ = sides_.inverse();
    }

    [[nodiscard]] Vec2d flat(const Vec3& p) const { return direction((p - origin_) / voxel_mm_); }
    [[nodiscard]] Vec2d direction(const Vec3& d) const { return {d.dot(x_axis_), d.dot(y_axis_)}; }
    [[nodiscard]] Vec3 lift(const Vec2d& q) const { return origin_ + voxel_mm_ * (q.x() * x_axis_ + q.y() * y_axis_); }

    /// Gradient of the linear function with these values at the corners.
    [[nodiscard]] Vec2d gradient(double f0, double f1, double f2) const {
        return inverse_.transpose() * Vec2d(f1 - f0, f2 - f0);
    }

    /// Where the way from `start` to q leaves the triangle less its margin; q if it does not. The faces that meet in q
    /// pass through the way's sides, so that no point of it is farther off them than `start`.
    [[nodiscard]] Vec2d clamped(const Vec2d& q, const Vec2d& start, double margin) const {
        const auto bary = [&](const Vec2d& p) {
            const Vec2d b = inverse_ * p;
            return Vec3(1.0 - b.x() - b.y(), b.x(), b.y());
        };
        return start + share_inside(bary(start), bary(q), margin) * (q - start);
    }

  private:
    Vec3 origin_, x_axis_, y_axis_;
    double voxel_mm_;
    Mat2d sides_, inverse_;
};

Vec2d plane_gradient(const TrianglePlane& plane, const std::array<EdgeEnd, 3>& corner, const WallVertex& v) {
    if (v.face != WallFace::kPattern) return plane.direction(v.normal.cast<double>());
    return plane.gradient(corner[0].pattern, corner[1].pattern, corner[2].pattern);
}

double face_value(const WallField& field, const WallSample& s, WallFace face) {
    switch (face) {
        case WallFace::kUpper:
            return s.phi - field.limits().upper;
        case WallFace::kLower:
            return field.limits().lower - s.phi;
        case WallFace::kPattern:
            break;
    }
    return s.pattern;
}

/// The sign of phi all over the simplex, or 0 if the surface passes through it.
template <std::size_t N>
double common_sign(const std::array<EdgeEnd, N>& corner) {
    const bool negative = corner[0].phi < 0.0;
    for (const EdgeEnd& c : corner)
        if ((c.phi < 0.0) != negative) return 0.0;
    return negative ? -1.0 : 1.0;
}

}  // namespace

bool edge_runs_between(const WallVertex& a, const WallVertex& b) {
    if (a.face != b.face) return true;
    return a.face != WallFace::kPattern && a.normal.dot(b.normal) < kFoldCosine;
}

std::optional<WallVertex> feature_on_triangle(const WallField& field, const std::array<EdgeEnd, 3>& corner,
                                              const WallVertex& a, const WallVertex& b, double margin) {
    const TrianglePlane plane(corner, field.voxel_mm());
    Mat2d jacobian;
    jacobian.row(0) = plane_gradient(plane, corner, a).transpose();
    jacobian.row(1) = plane_gradient(plane, corner, b).transpose();
    const double sine = std::abs(jacobian.determinant()) / (jacobian.row(0).norm() * jacobian.row(1).norm());
    if (!(sine > 0.1)) return std::nullopt;
    const Mat2d step = jacobian.inverse();
    Vec2d q =
        step * Vec2d(jacobian.row(0).dot(plane.flat(a.position_mm)), jacobian.row(1).dot(plane.flat(b.position_mm)));
    const double sign = common_sign(corner);
    const Vec2d start = 0.5 * (plane.flat(a.position_mm) + plane.flat(b.position_mm));
    for (int round = 0; round < kRounds; ++round) {
        if (!((q - start).norm() < kLongestMove)) return std::nullopt;
        const WallSample s = field.sample(plane.lift(q), sign, a.triangle);
        if (!s.found) return std::nullopt;
        const Vec2d off(face_value(field, s, a.face), face_value(field, s, b.face));
        const double worst = off.cwiseAbs().maxCoeff();
        // On a fold both faces are one function; its value says whether the facets' planes were the right ones.
        const bool last = a.face == b.face || round + 1 == kRounds;
        if (worst > 2e-3 && !last) {
            q -= step * off;
            continue;
        }
        if (worst > kAccepted) return std::nullopt;
        WallVertex v;
        v.feature = true;
        v.face = a.face == WallFace::kPattern ? b.face : a.face;
        // Halfway between two sheets either may be the closest; the edge belongs to the one of its faces.
        const bool other_sheet = field.triangle_normal(s.triangle).dot(field.triangle_normal(a.triangle)) < 0.0;
        v.triangle = other_sheet ? a.triangle : s.triangle;
        v.position_mm = plane.lift(plane.clamped(q, start, 2.0 * margin));
        v.to_target_mm = (plane.lift(q) - v.position_mm).cast<float>();
        return v;
    }
    return std::nullopt;
}

std::optional<WallVertex> corner_in_tetrahedron(const WallField& field, const std::array<EdgeEnd, 4>& corner,
                                                std::span<const WallVertex* const> loop, double margin) {
    Eigen::Matrix3d sides;
    for (int k = 0; k < 3; ++k)
        sides.col(k) = corner[static_cast<std::size_t>(k) + 1].position_mm - corner[0].position_mm;
    const Eigen::Matrix3d inverse = sides.inverse();
    const Vec3 rise(corner[1].pattern - corner[0].pattern, corner[2].pattern - corner[0].pattern,
                    corner[3].pattern - corner[0].pattern);
    const Vec3 pattern_normal = (inverse.transpose() * rise).normalized();

    Vec3 center = Vec3::Zero();
    for (const WallVertex* v : loop) center += v->position_mm / static_cast<double>(loop.size());
    Eigen::Matrix3d planes = 1e-4 * Eigen::Matrix3d::Identity();
    Vec3 right = Vec3::Zero();
    WallVertex result;
    for (const WallVertex* v : loop) {
        if (v->feature) continue;
        const Vec3 n = v->face == WallFace::kPattern ? pattern_normal : v->normal.cast<double>();
        if (!n.allFinite()) return std::nullopt;
        planes += n * n.transpose();
        right += n * n.dot(v->position_mm - center);
        result.triangle = v->triangle;
    }
    result.feature = true;
    const Vec3 target = center + planes.ldlt().solve(right);
    const double longest = (corner[3].position_mm - corner[0].position_mm).norm();
    if (!((target - center).norm() < longest)) return std::nullopt;
    // Nearly parallel planes meet anywhere.
    const WallSample s = field.sample(target, common_sign(corner), result.triangle);
    if (!s.found || std::abs(field.value(s)) > kAccepted) return std::nullopt;
    const auto bary = [&](const Vec3& p) {
        const Vec3 b = inverse * (p - corner[0].position_mm);
        return Eigen::Vector4d(1.0 - b.sum(), b[0], b[1], b[2]);
    };
    result.position_mm = center + share_inside(bary(center), bary(target), 2.0 * margin) * (target - center);
    result.to_target_mm = (target - result.position_mm).cast<float>();
    return result;
}

}  // namespace fretwork
