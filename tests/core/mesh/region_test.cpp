#include "core/mesh/region.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/region_shapes.h"
#include "core/mesh/sharp_edges.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double at(const TriangleMesh& mesh, const Region& region, const Vec3& p, std::uint32_t triangle = 0) {
    return RegionField(mesh, {region}).signed_distance_mm(p, triangle);
}

const TriangleMesh& box() {
    static const TriangleMesh mesh = make_box(Vec3::Zero(), Vec3(10, 10, 10), {5, 5, 5});
    return mesh;
}

TEST_CASE("regions: signed distances of the plain shapes are those of the drawing board", "[mesh]") {
    const Region cube{"cube", BoxRegion{Vec3(2, 2, -1), Vec3(8, 6, 1)}};
    CHECK(at(box(), cube, Vec3(5, 4, 0)) == -1.0);
    CHECK(at(box(), cube, Vec3(3.5, 4, 0)) == -1.0);
    CHECK(at(box(), cube, Vec3(2.25, 4, 0)) == -0.25);
    CHECK(at(box(), cube, Vec3(0, 4, 0)) == 2.0);
    CHECK(at(box(), cube, Vec3(11, 10, 0)) == 5.0);
    CHECK(at(box(), cube, Vec3(2, 4, 0)) == 0.0);

    const Region ball{"ball", SphereRegion{Vec3(0, 0, 10), 3.0}};
    CHECK(at(box(), ball, Vec3(0, 0, 10)) == -3.0);
    CHECK(at(box(), ball, Vec3(4, 3, 10)) == 2.0);

    const Region rod{"rod", CylinderRegion{Vec3(5, 5, 8), Vec3(5, 5, 12), 2.0}};
    CHECK(at(box(), rod, Vec3(5, 5, 10)) == -2.0);
    CHECK(at(box(), rod, Vec3(6, 5, 8.5)) == -0.5);
    CHECK(at(box(), rod, Vec3(5, 5, 13)) == 1.0);
    CHECK(at(box(), rod, Vec3(10, 5, 16)) == 5.0);

    const Region half{"half", HalfSpaceRegion{Vec3(0, 0, 4), Vec3(0, 0, 5)}};
    CHECK(at(box(), half, Vec3(1, 2, 7)) == 3.0);
    CHECK(at(box(), half, Vec3(1, 2, 1)) == -3.0);

    const Region band{"band", PlaneBandRegion{Vec3(0, 0, 4), Vec3(0, 0, -2), 1.5}};
    CHECK(at(box(), band, Vec3(9, 9, 4)) == -1.5);
    CHECK(at(box(), band, Vec3(9, 9, 7)) == 1.5);

    CHECK(at(box(), {"foot", LowestRegion{0.25}}, Vec3(0, 3, 4)) == 1.5);
    CHECK(at(box(), {"foot", LowestRegion{0.25}}, Vec3(0, 3, 0)) == -2.5);
    CHECK(at(box(), {"all", LowestRegion{1.0}}, Vec3(0, 3, 10)) == -kInfinity);
    CHECK(at(box(), {"all", EverywhereRegion{}}, Vec3(0, 3, 10)) == -kInfinity);
}

TEST_CASE("regions: a distance never exceeds the way to the border", "[mesh][property]") {
    // |d(p) - d(q)| <= |p - q| for every shape and every pair of points.
    const std::vector<Region> shapes = {{"box", BoxRegion{Vec3(2, 2, -1), Vec3(8, 6, 4)}},
                                        {"ball", SphereRegion{Vec3(1, 2, 9), 3.0}},
                                        {"rod", CylinderRegion{Vec3(-1, 2, 3), Vec3(9, 5, 8), 2.0}},
                                        {"half", HalfSpaceRegion{Vec3(1, 1, 4), Vec3(1, 2, 3)}},
                                        {"band", PlaneBandRegion{Vec3(1, 1, 4), Vec3(3, -2, 1), 1.0}},
                                        {"edges", SharpEdgeRegion{30, 1.0}},
                                        {"foot", LowestRegion{0.3}},
                                        {"volume", VolumeRegion{make_icosphere(4.0, 2, Vec3(3, 2, 8))}}};
    std::vector<Vec3> points;
    for (std::uint64_t i = 0; i < 200; ++i) {
        Vec3 p;
        for (std::uint32_t k = 0; k < 3; ++k)
            p[k] = 14 * unit_interval(counter_random(3, RandomStream::kTest, 0, i, k)) - 2;
        points.push_back(p);
    }
    for (const Region& shape : shapes) {
        CAPTURE(shape.name);
        const RegionField field(box(), {shape});
        std::size_t inside = 0;
        for (std::size_t i = 1; i < points.size(); ++i) {
            const double p = field.signed_distance_mm(points[i - 1], 0), q = field.signed_distance_mm(points[i], 0);
            CHECK(std::abs(p - q) <= (points[i - 1] - points[i]).norm() * (1 + 1e-12));
            inside += p < 0 ? 1 : 0;
        }
        CHECK(inside > 0);
        CHECK(inside < points.size());
    }
}

/// How far a volume reaches beyond its surface, so that faces that lie on it are inside.
constexpr double kTouchMm = 0.01;

TEST_CASE("regions: a volume is the shape that it encloses, and the faces that lie on it", "[mesh]") {
    const BoxRegion plain{Vec3(2, 2, -1), Vec3(8, 6, 1)};
    const Region volume{"volume", VolumeRegion{make_box(plain.min_mm, plain.max_mm, {3, 2, 1})}};
    const RegionField expected(box(), {{"box", plain}}), field(box(), {volume});
    for (std::uint64_t i = 0; i < 500; ++i) {
        Vec3 p;
        for (std::uint32_t k = 0; k < 3; ++k)
            p[k] = 14 * unit_interval(counter_random(5, RandomStream::kTest, 0, i, k)) - 2;
        CHECK(field.signed_distance_mm(p, 0) == Approx(expected.signed_distance_mm(p, 0) - kTouchMm).margin(1e-9));
    }
    // Below the box, and flush with it: the bottom is inside, the sides are not.
    const Region flush{"flush", VolumeRegion{make_box(Vec3(2, 2, -3), Vec3(8, 6, 0), {1, 1, 1})}};
    CHECK(at(box(), flush, Vec3(5, 4, 0)) < 0.0);
    CHECK(at(box(), flush, Vec3(5, 7, 0)) == Approx(1.0 - kTouchMm));
    // Inside out, it is the same volume.
    VolumeRegion turned{make_box(plain.min_mm, plain.max_mm, {1, 1, 1})};
    for (Triangle& t : turned.surface.triangles) std::swap(t[0], t[1]);
    CHECK(at(box(), {"turned", turned}, Vec3(5, 4, 0)) == Approx(-1.0 - kTouchMm));
}

TEST_CASE("regions: a volume meets the surface with its inside, a corner, or an edge through a face", "[mesh]") {
    const auto meets = [](const Vec3& min, const Vec3& max) {
        try {
            RegionField(box(), {{"v", VolumeRegion{make_box(min, max, {1, 1, 1})}}});
            return true;
        } catch (const InvalidSetting&) {
            return false;
        }
    };
    CHECK(meets(Vec3(-1, -1, -1), Vec3(11, 11, 11)));       // holds all of it
    CHECK(meets(Vec3(1.2, 1.2, 1), Vec3(1.4, 1.4, 12)));    // pierces a triangle between its vertices
    CHECK(meets(Vec3(1.2, 1.2, 10), Vec3(1.4, 1.4, 12)));   // stands on it
    CHECK_FALSE(meets(Vec3(1, 1, 1), Vec3(9, 9, 9)));       // within the hollow
    CHECK_FALSE(meets(Vec3(1, 1, 10.02), Vec3(9, 9, 12)));  // above it
}

TEST_CASE("regions: sharp edges and borders", "[mesh]") {
    CHECK(at(box(), {"edges", SharpEdgeRegion{45, 2.0}}, Vec3(5, 5, 0)) == 3.0);
    CHECK(at(box(), {"edges", SharpEdgeRegion{45, 2.0}}, Vec3(0.5, 5, 0)) == -1.5);
    const TriangleMesh sheet = make_square(10, 5);
    CHECK(at(sheet, {"rim", OpenBorderRegion{2.0}}, Vec3(3, 5, 0)) == 1.0);
    CHECK(at(sheet, {"rim", OpenBorderRegion{2.0}}, Vec3(1, 5, 0)) == -1.0);
}

TEST_CASE("regions: a set of triangles ends where its neighbours begin", "[mesh]") {
    const TriangleMesh sheet = make_square(10, 5);
    TriangleSetRegion left;  // the two columns x < 4
    for (std::uint32_t t = 0; t < sheet.triangles.size(); ++t)
        if (t / 2 % 5 < 2) left.triangles.push_back(t);
    const RegionField field(sheet, {{"left", left}});
    for (std::uint32_t t = 0; t < sheet.triangles.size(); ++t) {
        const Triangle& k = sheet.triangles[t];
        const Vec3 middle = (sheet.positions_mm[k[0]] + sheet.positions_mm[k[1]] + sheet.positions_mm[k[2]]) / 3.0;
        CHECK(field.signed_distance_mm(middle, t) == Approx(middle[0] - 4.0));  // not to the rim of the sheet
    }
    TriangleSetRegion all;
    for (std::uint32_t t = 0; t < sheet.triangles.size(); ++t) all.triangles.push_back(t);
    CHECK(at(sheet, {"all", all}, Vec3(1, 1, 0)) == -kInfinity);
}

TEST_CASE("regions: unions, and what lies outside of all", "[mesh]") {
    const Region low{"low", HalfSpaceRegion{Vec3(0, 0, 2), Vec3::UnitZ()}};
    const Region high{"high", HalfSpaceRegion{Vec3(0, 0, 7), -Vec3::UnitZ()}};
    const RegionField none(box(), {});
    CHECK(none.empty());
    CHECK(none.signed_distance_mm(Vec3(1, 2, 3), 0) == kInfinity);
    const RegionField both(box(), {low, high});
    CHECK_FALSE(both.empty());
    CHECK(both.signed_distance_mm(Vec3(0, 0, 4), 0) == 2.0);
    CHECK(both.signed_distance_mm(Vec3(0, 0, 1), 0) == -1.0);
    CHECK(both.signed_distance_mm(Vec3(0, 0, 9), 0) == -2.0);
    const RegionField middle(box(), {}, {low, high});
    CHECK_FALSE(middle.empty());
    CHECK(middle.signed_distance_mm(Vec3(0, 0, 4), 0) == -2.0);
    CHECK(middle.signed_distance_mm(Vec3(0, 0, 1), 0) == 1.0);
    const RegionField mixed(box(), {{"rod", CylinderRegion{Vec3(0, 0, -1), Vec3(0, 0, 11), 1.0}}}, {low, high});
    CHECK(mixed.signed_distance_mm(Vec3(0, 0, 1), 0) == -1.0);
}

TEST_CASE("regions: whether a shape meets a triangle agrees with sampling it", "[mesh][property]") {
    const auto seed = GENERATE(range(1u, 6u));
    CAPTURE(seed);
    const TriangleMesh soup = random_soup(seed, 300, 6.0);
    const BoxRegion cube{Vec3(-2, -1, 0), Vec3(1, 3, 2)};
    const SphereRegion ball{Vec3(1, 1, -1), 2.0};
    const CylinderRegion rod{Vec3(-1, -1, -2), Vec3(2, 1, 3), 1.2};
    const HalfSpaceRegion half{Vec3(4, 0, 0), Vec3(-1, -0.5, -0.2)};
    const PlaneBandRegion band{Vec3(3, 0, 0), Vec3(1, 0.5, 0), 0.4};
    const auto compare = [&](const auto& shape) {
        std::size_t met = 0;
        const TriangleMesh dense = random_soup(99, 4000, 6.0);  // so that the shape surely meets the mesh
        const auto prepared = regions::prepare(dense, {"shape", shape});
        for (const Triangle& t : soup.triangles) {
            const Vec3 &a = soup.positions_mm[t[0]], &b = soup.positions_mm[t[1]], &c = soup.positions_mm[t[2]];
            double least = kInfinity;
            constexpr int steps = 40;
            for (int i = 0; i <= steps; ++i)
                for (int j = 0; i + j <= steps; ++j)
                    least = std::min(least, prepared->signed_distance_mm(a + (i * (b - a) + j * (c - a)) / steps, 0));
            const double spacing = ((b - a).norm() + (c - a).norm()) / steps;
            const bool meets = regions::meets(shape, a, b, c);
            met += meets ? 1 : 0;
            if (least <= 0.0) CHECK(meets);
            if (least > spacing) CHECK_FALSE(meets);
        }
        CHECK(met > 5);
        CHECK(met < soup.triangles.size());
    };
    compare(cube);
    compare(ball);
    compare(rod);
    compare(half);
    compare(band);
}

TEST_CASE("regions: what cannot be meant is refused by name", "[mesh]") {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto refused = [](const Region& region, const std::string& says) {
        CAPTURE(says);
        CHECK_THROWS_AS(RegionField(box(), {region}), InvalidSetting);
        CHECK_THROWS_WITH(RegionField(box(), {region}),
                          Catch::Contains("'" + region.name + "'") && Catch::Contains(says));
        CHECK_THROWS_AS(RegionField(box(), {}, {region}), InvalidSetting);
    };
    refused({"a", BoxRegion{Vec3(1, 1, 1), Vec3(2, 1, 2)}}, "the box is empty: min y");
    refused({"b", BoxRegion{Vec3(1, 1, 1), Vec3(nan, 2, 2)}}, "not finite");
    refused({"c", BoxRegion{Vec3(3, 3, 3), Vec3(6, 6, 6)}}, "meets no part of the surface");
    refused({"d", SphereRegion{Vec3(5, 5, 5), 0}}, "radius is 0");
    refused({"e", SphereRegion{Vec3(5, 5, 5), 4.9}}, "meets no part");
    refused({"f", SphereRegion{Vec3(5, 5, 5), kInfinity}}, "radius");
    refused({"g", CylinderRegion{Vec3(5, 5, 5), Vec3(5, 5, 5), 1}}, "no length");
    refused({"h", CylinderRegion{Vec3(5, 5, 1), Vec3(5, 5, 9), 4.9}}, "meets no part");
    refused({"i", HalfSpaceRegion{Vec3(0, 0, -1), Vec3::UnitZ()}}, "meets no part");
    refused({"j", HalfSpaceRegion{Vec3(0, 0, 1), Vec3::Zero()}}, "zero vector");
    refused({"k", PlaneBandRegion{Vec3(0, 0, 12), Vec3::UnitZ(), 1.9}}, "meets no part");
    refused({"l", PlaneBandRegion{Vec3(0, 0, 1), Vec3::UnitZ(), -1}}, "half width");
    refused({"m", SharpEdgeRegion{91, 1}}, "no edge is folded");
    refused({"n", SharpEdgeRegion{200, 1}}, "min angle");
    refused({"o", OpenBorderRegion{1}}, "closed");
    refused({"p", TriangleSetRegion{}}, "names no triangle");
    refused({"q", TriangleSetRegion{{0, 300}}}, "names triangle 300, but the mesh has 300 triangles");
    refused({"t", VolumeRegion{}}, "no triangle");
    refused({"u", VolumeRegion{make_square(10, 1)}}, "not closed: 4 edges");
    refused({"v", VolumeRegion{{{Vec3(nan, 0, 0)}, {{0, 0, 0}}}}}, "not finite");
    refused({"w", VolumeRegion{{{Vec3(0, 0, 0)}, {{0, 1, 0}}}}}, "vertex 1, and there are 1");
    refused({"r", LowestRegion{0}}, "share is 0");
    refused({"s", LowestRegion{1.5}}, "share is 1.5");
    CHECK_THROWS_AS(RegionField(TriangleMesh{}, {}), InvalidInput);
}

TEST_CASE("regions: the same from any number of threads", "[mesh]") {
    const TriangleMesh mesh = make_bracket();
    const RegionField field(mesh, {{"edges", SharpEdgeRegion{30, 1.0}}, {"foot", LowestRegion{0.1}}});
    const auto sample = [&] {
        std::vector<double> values(mesh.positions_mm.size());
        parallel_for(values.size(), 16,
                     [&](std::size_t v) { values[v] = field.signed_distance_mm(0.9 * mesh.positions_mm[v], 0); });
        return values;
    };
    const std::vector<double> many = sample();
    const ThreadLimit one(1);
    CHECK(sample() == many);
}

TEST_CASE("sharp edges: a box has twelve, each as finely split as its sides", "[mesh]") {
    CHECK(sharp_edges(box(), 30).size() == 12 * 5);
    for (const MeshEdge& e : sharp_edges(box(), 30)) CHECK(e.fold_deg == Approx(90.0));
    CHECK(sharp_edges(box(), 90).empty());
    CHECK(sharp_edges(box(), 89.999).size() == 60);
    CHECK(sharp_edges(inverted(box()), 30).size() == 60);
    CHECK(sharp_edges(with_flipped(box(), 3), 30).size() == 60);  // folds do not depend on the turn
    CHECK(sharp_edges(make_sphere(10, 32, 64), 12).empty());
    CHECK(sharp_edges(make_three_fins(), 180).size() == 1);
    CHECK_THROWS_AS(sharp_edges(box(), -1), InvalidSetting);
    CHECK_THROWS_AS(sharp_edges({}, 30), InvalidInput);
}

TEST_CASE("sharp edges: folds of a prism are the outer angles of its polygon", "[mesh]") {
    const TriangleMesh prism = make_cylinder(10, 5, 12, 1);
    std::size_t sides = 0, rims = 0;
    for (const MeshEdge& e : sharp_edges(prism, 5)) {
        if (e.fold_deg == Approx(30.0)) ++sides;
        if (e.fold_deg == Approx(90.0)) ++rims;
    }
    CHECK(sides == 12);
    CHECK(rims == 24);
}

TEST_CASE("border edges: rims of open surfaces only", "[mesh]") {
    CHECK(border_edges(make_bracket()).empty());
    CHECK(border_edges(make_open_bowl(10, 8, 24)).size() == 24);
    CHECK(border_edges(make_square(3, 4)).size() == 16);
}

}  // namespace
}  // namespace fretwork
