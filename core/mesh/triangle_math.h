// Points, segments and triangles in double precision: the small geometry that several files of this folder share.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/vec.h"

namespace fretwork {

/// In the plane or in space.
template <class Vec>
Vec closest_on_segment(const Vec& p, const Vec& a, const Vec& b) {
    const Vec ab = b - a;
    const double length2 = ab.squaredNorm();
    if (!(length2 > 0.0)) return a;
    const double t = (p - a).dot(ab) / length2;
    if (t <= 0.0) return a;
    if (t >= 1.0) return b;
    return a + t * ab;
}

/// The point of the triangle closest to p; of any shape, also a segment or a point. By the Voronoi regions of
/// \cite ericson2004collision, section 5.1.5, where the triangle is not a sliver.
inline Vec3 closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 ab = b - a, ac = c - a, ap = p - a;
    const double bb = ab.squaredNorm(), cc = ac.squaredNorm(), bc = ab.dot(ac);
    const double d1 = ab.dot(ap), d2 = ac.dot(ap);
    const double det = bb * cc - bc * bc;  // squared double area
    if (!(det > 1e-10 * bb * cc)) {
        // A sliver: its normal is noise, but its three sides are as wide as it is.
        const Vec3 on_ab = closest_on_segment(p, a, b), on_bc = closest_on_segment(p, b, c),
                   on_ca = closest_on_segment(p, c, a);
        const double e_ab = (p - on_ab).squaredNorm(), e_bc = (p - on_bc).squaredNorm(),
                     e_ca = (p - on_ca).squaredNorm();
        Vec3 best = e_ab <= e_bc && e_ab <= e_ca ? on_ab : e_bc <= e_ca ? on_bc : on_ca;
        if (det > 0.0) {  // A point inside counts only if it is better, and it is on the triangle by construction.
            const double v = std::clamp((cc * d1 - bc * d2) / det, 0.0, 1.0);
            const double w = std::clamp((bb * d2 - bc * d1) / det, 0.0, 1.0 - v);
            const Vec3 within = a + v * ab + w * ac;
            if ((p - within).squaredNorm() < (p - best).squaredNorm()) best = within;
        }
        return best;
    }
    if (d1 <= 0.0 && d2 <= 0.0) return a;
    const Vec3 bp = p - b;
    const double d3 = ab.dot(bp), d4 = ac.dot(bp);
    if (d3 >= 0.0 && d4 <= d3) return b;
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return a + (d1 / (d1 - d3)) * ab;
    const Vec3 cp = p - c;
    const double d5 = ab.dot(cp), d6 = ac.dot(cp);
    if (d6 >= 0.0 && d5 <= d6) return c;
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return a + (d2 / (d2 - d6)) * ac;
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return b + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (c - b);
    const double sum = va + vb + vc;
    return a + (vb / sum) * ab + (vc / sum) * ac;
}

/// No wider than 1e-12 of its length: what carries no direction and no area to speak of.
inline bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
    const double longest2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return !((b - a).cross(c - a).squaredNorm() > 1e-24 * longest2 * longest2);
}

/// How a segment meets a triangle.
struct TriangleCrossing {
    double parameter;  ///< along the segment, in [0, 1]
    bool leaving;      ///< along the normal
    bool on_edge;      ///< passes exactly through an edge or a corner, as far as double can tell
};

/// Seen along the segment, as in \cite woop2013watertight: each corner becomes a point of a plane in which the segment
/// is the origin, by numbers that depend on the corner and the segment alone; the side of an edge is one difference of
/// two products, whose sign rounding can only turn into zero; and zero counts as a hit. So all triangles of a seam or a
/// corner agree, and a segment cannot slip through.
inline std::optional<TriangleCrossing> cross_triangle(const Vec3& from, const Vec3& to, const Vec3& a, const Vec3& b,
                                                      const Vec3& c) {
    const Vec3 d = to - from;
    Eigen::Index z = 0;
    if (d.cwiseAbs().maxCoeff(&z) == 0.0) return std::nullopt;
    const Eigen::Index x = (z + 1) % 3, y = (z + 2) % 3;
    const double shear_x = d[x] / d[z], shear_y = d[y] / d[z];
    const auto seen = [&](const Vec3& p) {
        const double depth = p[z] - from[z];
        return Vec2(p[x] - from[x] - shear_x * depth, p[y] - from[y] - shear_y * depth);
    };
    const Vec2 pa = seen(a), pb = seen(b), pc = seen(c);
    const double ab = pa[0] * pb[1] - pa[1] * pb[0], bc = pb[0] * pc[1] - pb[1] * pc[0],
                 ca = pc[0] * pa[1] - pc[1] * pa[0];
    const bool any_negative = ab < 0.0 || bc < 0.0 || ca<0.0, any_positive = ab> 0.0 || bc > 0.0 || ca > 0.0;
    if (any_negative == any_positive) return std::nullopt;  // outside, or the segment lies in the plane
    const Vec3 normal = (b - a).cross(c - a);
    const double before = normal.dot(from - a), after = normal.dot(to - a);
    if ((before > 0.0 && after > 0.0) || (before < 0.0 && after < 0.0) || before == after) return std::nullopt;
    return TriangleCrossing{std::clamp(before / (before - after), 0.0, 1.0), after > before,
                            ab == 0.0 || bc == 0.0 || ca == 0.0};
}

}  // namespace fretwork
