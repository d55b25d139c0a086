#include "core/mesh/mesh_distance.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <stop_token>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

constexpr MeshDistanceSettings kFew{.samples = 5000, .seed = 1};

TEST_CASE("mesh distance: zero to itself, the shift to a shifted plate", "[mesh]") {
    const TriangleMesh bracket = make_bracket();
    CHECK(mesh_distance(bracket, bracket, kFew).max_mm() < 1e-12);
    CHECK(mesh_distance(bracket, as_soup(shuffled(bracket, 4)), kFew).max_mm() < 1e-12);
    const MeshDistance lifted = mesh_distance(make_square(10), translated(make_square(10, 7), Vec3(0, 0, 0.25)), kFew);
    CHECK(lifted.max_mm() == Approx(0.25));
    CHECK(lifted.from_first.mean_mm == Approx(0.25));
    CHECK(lifted.from_second.root_mean_square_mm == Approx(0.25));
}

TEST_CASE("mesh distance: each side has its own maximum", "[mesh]") {
    // A small square within a large one: the corners of the large are 5 sqrt 2 away, the small is not away at all.
    const TriangleMesh small = translated(make_square(10), Vec3(5, 5, 0)), large = make_square(20);
    const MeshDistance d = mesh_distance(small, large, kFew);
    CHECK(d.from_first.max_mm == Approx(0.0).margin(1e-12));
    CHECK(d.from_second.max_mm == Approx(5 * std::sqrt(2.0)));
    CHECK(d.max_mm() == d.from_second.max_mm);
}

TEST_CASE("mesh distance: spheres apart by their radii, mean by area", "[mesh]") {
    const MeshDistance d = mesh_distance(make_icosphere(10, 4), make_icosphere(11, 4), kFew);
    CHECK(d.from_first.mean_mm == Approx(1.0).epsilon(0.02));
    CHECK(d.max_mm() < 1.05);
    // Area, not triangles, weighs: all but one strip of a plate lies in the other plate's plane.
    TriangleMesh bent = make_square(10, 10);
    for (Vec3& p : bent.positions_mm) p[2] = p[0] > 9.5 ? 1.0 : 0.0;
    CHECK(mesh_distance(bent, make_square(10), {.samples = 50000, .seed = 3}).from_first.mean_mm ==
          Approx(0.5 * std::sqrt(2.0) / (9.0 + std::sqrt(2.0))).epsilon(0.01));
}

TEST_CASE("mesh distance: same for any number of threads; refuses; stops", "[mesh]") {
    const TriangleMesh a = make_vase(50), b = make_vase(51);
    const MeshDistance many = mesh_distance(a, b, kFew);
    const ThreadLimit one(1);
    const MeshDistance few = mesh_distance(a, b, kFew);
    CHECK(many.from_first.mean_mm == few.from_first.mean_mm);
    CHECK(many.from_second.max_mm == few.from_second.max_mm);
    CHECK_THROWS_AS(mesh_distance(a, b, {.samples = 0, .seed = 1}), InvalidSetting);
    CHECK_THROWS_WITH(mesh_distance(a, {}, kFew), Catch::Contains("second mesh"));
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(mesh_distance(a, b, kFew, RunControl({}, source.get_token())), Cancelled);
}

}  // namespace
}  // namespace fretwork
