#include "support/make_meshes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <utility>

namespace fretwork::testing {
namespace {

/// Euler characteristic if every directed edge has exactly one opposite partner, else a number no surface has.
long euler_of_closed(const TriangleMesh& mesh) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> directed;
    std::set<std::uint32_t> used;
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            ++directed[{t[k], t[(k + 1) % 3]}];
            used.insert(t[k]);
        }
    for (const auto& [edge, count] : directed) {
        const auto back = directed.find({edge.second, edge.first});
        if (count != 1 || back == directed.end() || back->second != 1) return 1000;
    }
    return static_cast<long>(used.size()) - static_cast<long>(directed.size() / 2) +
           static_cast<long>(mesh.triangles.size());
}

struct Closed {
    const char* name;
    TriangleMesh mesh;
    long euler;
    double volume_mm3;
};

TEST_CASE("make_meshes: closed fixtures are closed, outward and as large as they say", "[support]") {
    const double pi48 = polygon_pi(48), pi64 = polygon_pi(64);
    const std::vector<Closed> all = {
        {"box", make_box(Vec3(-1, 0, 2), Vec3(3, 5, 9), {3, 1, 4}), 2, 4.0 * 5.0 * 7.0},
        {"thin plate", make_thin_plate(40, 30, 0.5, 8), 2, 600.0},
        {"frame", make_frame(30, 6), -8, 27000.0 - 5832.0 - 6 * 324.0 * 6},
        {"double ring", make_double_ring(10, 5), -2, 5.0 * (35.0 * 20.0 - 200.0)},
        {"bracket", make_bracket(), -10, bracket_volume_mm3()},
        {"cylinder", make_cylinder(5, 20, 48), 2, pi48 * 25 * 20},
        {"tube", make_tube(5, 3, 20, 48), 0, pi48 * 16 * 20},
        {"vase", make_vase(80), 2, vase_volume_mm3(80)},
        {"pinched", make_pinched_vertex(), 3, 2 * 1.5 / 3.0},
        {"overlapping boxes", make_overlapping_boxes(), 4, 16.0},
    };
    for (const Closed& c : all) {
        CAPTURE(c.name);
        CHECK(euler_of_closed(c.mesh) == c.euler);
        CHECK(volume_mm3(c.mesh) == Approx(c.volume_mm3).epsilon(1e-9));
    }
    CHECK(polygon_pi(4) == Approx(2.0));
    CHECK(pi64 < std::numbers::pi);
}

TEST_CASE("make_meshes: round fixtures approach the smooth shape from inside", "[support]") {
    const double pi = std::numbers::pi;
    const auto within = [](double value, double limit, double share) {
        CHECK(value < limit);
        CHECK(value > limit * (1.0 - share));
    };
    const TriangleMesh ball = make_icosphere(10, 4), globe = make_sphere(10, 48, 96);
    for (const TriangleMesh* mesh : {&ball, &globe}) {
        CHECK(euler_of_closed(*mesh) == 2);
        within(volume_mm3(*mesh), 4.0 / 3.0 * pi * 1000, 0.005);
        within(area_mm2(*mesh), 4.0 * pi * 100, 0.005);
        for (const Vec3& p : mesh->positions_mm) CHECK(p.norm() == Approx(10.0));
    }
    const TriangleMesh torus = make_torus(10, 3, 96, 48);
    CHECK(euler_of_closed(torus) == 0);
    within(volume_mm3(torus), 2 * pi * pi * 10 * 9, 0.01);
    const TriangleMesh tori = make_linked_tori(10, 3, 96, 48);
    CHECK(euler_of_closed(tori) == 0);
    CHECK(volume_mm3(tori) == Approx(2 * volume_mm3(torus)));
    const TriangleMesh shells = make_nested_spheres(10, 5, 3);
    CHECK(euler_of_closed(shells) == 4);
    CHECK(volume_mm3(shells) == Approx(volume_mm3(make_icosphere(10, 3)) * (1.0 - 0.125)));
}

TEST_CASE("make_meshes: open fixtures have the border they say", "[support]") {
    CHECK(area_mm2(make_square(16)) == Approx(256.0));
    CHECK(area_mm2(make_square(16, 5)) == Approx(256.0));
    const TriangleMesh bowl = make_open_bowl(10, 16, 40);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
    for (const Triangle& t : bowl.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++edges[std::minmax(t[k], t[(k + 1) % 3])];
    CHECK(std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second == 1; }) == 40);
    for (const Triangle& t : bowl.triangles) {
        const Vec3 &a = bowl.positions_mm[t[0]], &b = bowl.positions_mm[t[1]], &c = bowl.positions_mm[t[2]];
        CHECK((b - a).cross(c - a).dot(a + b + c) > 0.0);
    }
}

TEST_CASE("make_meshes: shuffling keeps the surface", "[support]") {
    const TriangleMesh mesh = make_bracket(), mixed = shuffled(mesh, 7);
    CHECK(euler_of_closed(mixed) == euler_of_closed(mesh));
    CHECK(volume_mm3(mixed) == Approx(volume_mm3(mesh)));
    CHECK(mixed.triangles != mesh.triangles);
    CHECK(volume_mm3(rotated(mesh, Vec3(1, 2, 3), 1.0)) == Approx(volume_mm3(mesh)));
    CHECK(volume_mm3(inverted(mesh)) == Approx(-volume_mm3(mesh)));
}

}  // namespace
}  // namespace fretwork::testing
