#include "core/mesh/closest_point.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <stop_token>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

Vec3 random_point(std::uint64_t seed, std::uint64_t item, double extent) {
    Vec3 p;
    for (std::uint32_t axis = 0; axis < 3; ++axis)
        p[axis] = extent * (2 * unit_interval(counter_random(seed, RandomStream::kTest, 9, item, axis)) - 1);
    return p;
}

using LongVec = Eigen::Matrix<long double, 3, 1>;

LongVec longer(const Vec3& p) {
    return p.cast<long double>();
}

/// Distance from a point to a triangle by trying its face, its sides and its corners, in long double.
double oracle_distance(const Vec3& point, const Vec3& ca, const Vec3& cb, const Vec3& cc) {
    const LongVec p = longer(point);
    const std::array<LongVec, 3> corner = {longer(ca), longer(cb), longer(cc)};
    long double best = std::numeric_limits<long double>::infinity();
    for (std::size_t k = 0; k < 3; ++k) {
        const LongVec a = corner[k], b = corner[(k + 1) % 3];
        const long double length2 = (b - a).squaredNorm();
        const long double t = length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0L, 1.0L) : 0.0L;
        best = std::min(best, (p - a - t * (b - a)).norm());
    }
    const LongVec n = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    if (n.squaredNorm() > 0) {
        const LongVec q = p - n.dot(p - corner[0]) / n.squaredNorm() * n;
        bool within = true;
        for (std::size_t k = 0; k < 3; ++k)
            within = within && n.dot((corner[(k + 1) % 3] - corner[k]).cross(q - corner[k])) >= 0;
        if (within) best = std::min(best, (p - q).norm());
    }
    return static_cast<double>(best);
}

double oracle_distance(const Vec3& p, const TriangleMesh& mesh) {
    double best = std::numeric_limits<double>::infinity();
    for (const Triangle& t : mesh.triangles)
        best = std::min(best,
                        oracle_distance(p, mesh.positions_mm[t[0]], mesh.positions_mm[t[1]], mesh.positions_mm[t[2]]));
    return best;
}

/// Soups of all sizes of triangles, with slivers, segments and points among them.
TriangleMesh wild_soup(std::uint64_t seed) {
    TriangleMesh mesh = random_soup(seed, 60, 10.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Vec3 &a = mesh.positions_mm[3 * t], &b = mesh.positions_mm[3 * t + 1], &c = mesh.positions_mm[3 * t + 2];
        switch (t % 6) {
            case 0:
                b = a + 0.01 * (b - a), c = a + 0.01 * (c - a);
                break;  // small
            case 1:
                c = a + 0.4 * (b - a) + 1e-7 * (c - a);
                break;  // cap
            case 2:
                c = b + 1e-8 * (c - b);
                break;  // needle
            case 3:
                c = a + 0.3 * (b - a);
                break;  // line
            case 4:
                b = c = a;
                break;  // point
            default:
                break;
        }
    }
    return mesh;
}

TEST_CASE("surface tree: closest points agree with trying every triangle", "[mesh][property]") {
    const auto seed = GENERATE(range(1u, 9u));
    CAPTURE(seed);
    const TriangleMesh mesh = wild_soup(seed);
    const SurfaceTree tree(mesh);
    for (std::uint64_t i = 0; i < 400; ++i) {
        const Vec3 p = random_point(seed, i, i % 10 == 0 ? 1e3 : i % 10 == 1 ? 1e9 : 15.0);
        const ClosestPoint c = tree.closest(p);
        const double expected = oracle_distance(p, mesh);
        CAPTURE(i);
        REQUIRE(c.found());
        CHECK(std::abs(c.distance_mm - expected) <= 1e-12 * (p.norm() + 20.0));
        CHECK(c.distance_mm == (p - c.point_mm).norm());
        const Triangle& t = mesh.triangles[c.triangle];
        CHECK(oracle_distance(c.point_mm, mesh.positions_mm[t[0]], mesh.positions_mm[t[1]], mesh.positions_mm[t[2]]) <
              1e-13 * 20);
    }
}

TEST_CASE("surface tree: a reach finds the same or nothing", "[mesh][property]") {
    const TriangleMesh mesh = wild_soup(3);
    const SurfaceTree tree(mesh);
    std::size_t inside = 0;
    for (std::uint64_t i = 0; i < 500; ++i) {
        const Vec3 p = random_point(5, i, 15.0);
        const ClosestPoint any = tree.closest(p);
        const ClosestPoint near = tree.closest(p, 2.0);
        CHECK(near.found() == (any.distance_mm <= 2.0));
        if (!near.found()) continue;
        ++inside;
        CHECK(near.triangle == any.triangle);
        CHECK(near.point_mm == any.point_mm);
        CHECK(tree.closest(p, any.distance_mm).triangle == any.triangle);
        CHECK_FALSE(tree.closest(p, any.distance_mm * (1 - 1e-9)).found());
    }
    CHECK(inside > 50);
}

TEST_CASE("surface tree: bulk answers are those of single queries, for any number of threads", "[mesh]") {
    const TriangleMesh mesh = make_bracket();
    const SurfaceTree tree(mesh);
    std::vector<Vec3> points;
    for (std::uint64_t i = 0; i < 5000; ++i) points.push_back(Vec3(30, 20, 15) + random_point(1, i, 35.0));
    // Points level with edges and corners are as close to several triangles; the lowest must win everywhere.
    for (const Vec3& p : mesh.positions_mm) points.push_back(p), points.push_back(p - Vec3(1, 1, 1));
    const std::vector<ClosestPoint> many = tree.closest(points);
    const ThreadLimit one(1);
    const std::vector<ClosestPoint> few = tree.closest(points);
    for (std::size_t i = 0; i < points.size(); ++i) {
        const ClosestPoint single = tree.closest(points[i]);
        CHECK(many[i].triangle == single.triangle);
        CHECK(many[i].point_mm == single.point_mm);
        CHECK(few[i].triangle == single.triangle);
    }
}

TEST_CASE("surface tree: hits of a segment agree with trying every triangle", "[mesh][property]") {
    const auto seed = GENERATE(range(1u, 9u));
    CAPTURE(seed);
    const TriangleMesh mesh = random_soup(seed, 200, 10.0);
    const SurfaceTree tree(mesh);
    std::vector<SegmentHit> hits;
    for (std::uint64_t i = 0; i < 200; ++i) {
        const double extent = i % 4 == 0 ? 100.0 : 12.0;
        const Vec3 from = random_point(seed, 2 * i, extent);
        const Vec3 to =
            i % 3 == 0 ? Vec3(from + random_point(seed, 2 * i + 1, 0.5)) : random_point(seed, 2 * i + 1, extent);
        std::vector<std::pair<double, std::uint32_t>> expected;
        for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
            // Solves from + s d = a + u (b - a) + v (c - a).
            const Vec3 a = mesh.positions_mm[3 * t], b = mesh.positions_mm[3 * t + 1], c = mesh.positions_mm[3 * t + 2];
            Eigen::Matrix3d m;
            m << from - to, b - a, c - a;
            const Vec3 s = m.inverse() * (from - a);
            if (s[0] >= 0 && s[0] <= 1 && s[1] >= 0 && s[2] >= 0 && s[1] + s[2] <= 1) expected.emplace_back(s[0], t);
        }
        std::sort(expected.begin(), expected.end());
        tree.all_hits(from, to, hits);
        CAPTURE(i);
        REQUIRE(hits.size() == expected.size());
        for (std::size_t k = 0; k < hits.size(); ++k) {
            CHECK(hits[k].triangle == expected[k].second);
            CHECK(hits[k].parameter == Approx(expected[k].first).margin(1e-9));
            const Triangle& t = mesh.triangles[hits[k].triangle];
            const Vec3 normal = (mesh.positions_mm[t[1]] - mesh.positions_mm[t[0]])
                                    .cross(mesh.positions_mm[t[2]] - mesh.positions_mm[t[0]]);
            CHECK(hits[k].leaving == ((to - from).dot(normal) > 0));
        }
        const auto first = tree.first_hit(from, to);
        REQUIRE(first.has_value() == !expected.empty());
        if (first) CHECK(first->triangle == expected[0].second);
    }
}

TEST_CASE("surface tree: no segment slips through a seam", "[mesh][property]") {
    // From the centre through points on edges and corners of a sphere, and through points a rounding beside them.
    const TriangleMesh ball = make_icosphere(10.0, 3, Vec3(0.1, -0.2, 0.3));
    const SurfaceTree tree(ball);
    const Vec3 center(0.1, -0.2, 0.3);
    for (const Triangle& t : ball.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3 &a = ball.positions_mm[t[k]], &b = ball.positions_mm[t[(k + 1) % 3]];
            for (const double along : {0.0, 0.1, 0.5, 1.0 / 3.0}) {
                const Vec3 through = a + along * (b - a);
                const auto hit = tree.first_hit(center, center + 1.5 * (through - center));
                REQUIRE(hit.has_value());
                CHECK(hit->parameter == Approx(1 / 1.5).margin(0.02));
                CHECK(hit->leaving);
                REQUIRE(tree.first_hit(center + 1.5 * (through - center), center).has_value());
            }
        }
}

TEST_CASE("surface tree: roots on a flat face are exact", "[mesh]") {
    const SurfaceTree tree(make_box(Vec3::Zero(), Vec3(8, 8, 8), {4, 4, 4}));
    const auto hit = tree.first_hit(Vec3(3.3, 1.7, -1), Vec3(3.3, 1.7, 3));
    REQUIRE(hit);
    CHECK(hit->parameter == 0.25);
    CHECK_FALSE(hit->leaving);
    CHECK_FALSE(tree.first_hit(Vec3(3.3, 1.7, -1), Vec3(3.3, 1.7, -0.001)));
    CHECK_FALSE(tree.first_hit(Vec3(1, 1, 1), Vec3(1, 1, 1)));
    CHECK(tree.first_hit(Vec3(1, 1.5, -1), Vec3(1, 1.5, 0)));  // ends included
    CHECK(tree.first_hit(Vec3(1, 1.5, -1e8), Vec3(1, 1.5, 1e8)));
}

TEST_CASE("surface tree: winding numbers count the layers", "[mesh]") {
    const TriangleMesh ball = make_icosphere(10, 4);
    const SurfaceTree one(ball), none(inverted(ball)), hollow(make_nested_spheres(10, 5, 4)),
        two(joined(ball, make_icosphere(5, 4)));
    for (std::uint64_t i = 0; i < 300; ++i) {
        const Vec3 p = random_point(2, i, 14.0);
        const double r = p.norm();
        if (std::abs(r - 10) < 0.1 || std::abs(r - 5) < 0.1) continue;
        CAPTURE(i);
        CHECK(one.winding_number(p) == Approx(r < 10 ? 1 : 0).margin(0.01));
        CHECK(none.winding_number(p) == Approx(r < 10 ? -1 : 0).margin(0.01));
        CHECK(hollow.winding_number(p) == Approx(r < 10 && r > 5 ? 1 : 0).margin(0.01));
        CHECK(two.winding_number(p) == Approx(r < 5 ? 2 : r < 10 ? 1 : 0).margin(0.02));
        CHECK(one.inside(p) == (r < 10));
        CHECK(hollow.inside(p) == (r < 10 && r > 5));
        CHECK(two.inside(p) == (r < 10));
        CHECK_FALSE(none.inside(p));
        CHECK(one.signed_distance_mm(p) == Approx(r - 10).margin(0.05));
    }
}

TEST_CASE("surface tree: the sum of far groups agrees with the sum over all triangles", "[mesh][property]") {
    const TriangleMesh bowl = make_open_bowl(10, 24, 48);
    const SurfaceTree tree(bowl);
    for (std::uint64_t i = 0; i < 200; ++i) {
        const Vec3 p = random_point(4, i, 20.0);
        double sum = 0.0;  // solid angle by the formula of van Oosterom and Strackee
        for (const Triangle& t : bowl.triangles) {
            const Vec3 a = bowl.positions_mm[t[0]] - p, b = bowl.positions_mm[t[1]] - p,
                       c = bowl.positions_mm[t[2]] - p;
            sum += std::atan2(a.dot(b.cross(c)), a.norm() * b.norm() * c.norm() + a.dot(b) * c.norm() +
                                                     b.dot(c) * a.norm() + c.dot(a) * b.norm());
        }
        CHECK(tree.winding_number(p) == Approx(sum / (2 * std::numbers::pi)).margin(0.01));
    }
    // Over the rim of a half sphere the winding number is one half by symmetry.
    CHECK(tree.winding_number(Vec3::Zero()) == Approx(0.5).margin(0.01));
    CHECK(tree.inside(Vec3(0, 0, -5)));
    CHECK_FALSE(tree.inside(Vec3(0, 0, 5)));
}

TEST_CASE("surface tree: inside of a boxy part agrees with its blocks", "[mesh]") {
    const double side = 30, bar = 6;
    const SurfaceTree tree(make_frame(side, bar, 1));
    // On a lattice, so that rays meet edges and faces of the frame squarely.
    for (int i = 0; i < 20 * 20 * 20; ++i) {
        const Vec3 p(1.5 * (i % 20) + 0.75, 1.5 * (i / 20 % 20) + 0.75, 1.5 * (i / 400) + 0.75);
        int middles = 0;
        for (int axis = 0; axis < 3; ++axis) middles += p[axis] > bar && p[axis] < side - bar ? 1 : 0;
        CHECK(tree.inside(p) == (middles <= 1));
    }
}

TEST_CASE("surface tree: bad meshes are refused, a stop is honoured", "[mesh]") {
    CHECK_THROWS_AS(SurfaceTree(TriangleMesh{}), InvalidInput);
    TriangleMesh bad = make_square(1);
    bad.triangles[0][0] = 4;
    CHECK_THROWS_WITH(SurfaceTree(bad), Catch::Contains("triangle 0 names vertex 4"));
    bad = make_square(1);
    bad.positions_mm[1][2] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(SurfaceTree(bad), InvalidInput);
    std::stop_source source;
    source.request_stop();
    const std::vector<Vec3> points(10, Vec3::Zero());
    CHECK_THROWS_AS(SurfaceTree(make_square(1)).closest(points, 1.0, RunControl({}, source.get_token())), Cancelled);
}

}  // namespace
}  // namespace fretwork
