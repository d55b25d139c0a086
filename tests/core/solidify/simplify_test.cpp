#include "core/solidify/simplify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <set>

#include "core/mesh/mesh_report.h"
#include "core/mesh/self_intersections.h"
#include "core/solidify/block_simplifier.h"
#include "core/solidify/collapse_log.h"
#include "core/solidify/color_areas.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

MeshAreas one_area(const TriangleMesh& mesh) {
    return {std::vector<std::uint8_t>(mesh.triangles.size(), 0),
            std::vector<std::uint8_t>(mesh.positions_mm.size(), 0)};
}

std::set<Triangle> alive(const CollapseMesh& mesh) {
    std::set<Triangle> triangles;
    for (std::uint32_t t = 0; t < mesh.triangle_slots(); ++t) {
        if (!mesh.triangle_alive(t)) continue;
        Triangle k = mesh.triangle(t);
        std::rotate(k.begin(), std::min_element(k.begin(), k.end()), k.end());
        triangles.insert(k);
    }
    return triangles;
}

TEST_CASE("collapse log: taking everything back gives the mesh that was", "[solidify]") {
    const TriangleMesh sphere = testing::make_icosphere(10.0, 4);
    const MeshAreas areas = one_area(sphere);
    SimplifyState state(sphere, areas);
    state.shape.resize(sphere.triangles.size());
    for (std::uint32_t t = 0; t < sphere.triangles.size(); ++t) state.measure(t);
    const std::set<Triangle> before = alive(state.mesh);

    std::vector<std::uint32_t> block(sphere.positions_mm.size(), 0), order(sphere.positions_mm.size());
    for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
    std::vector<CollapseMesh::Corner> entries;
    BlockSimplifier worker(state, block, std::numeric_limits<double>::infinity(), entries);
    for (int sweep = 0; sweep < 3; ++sweep) worker.sweep(order, 0.3, false);
    const std::size_t fewest = alive(state.mesh).size();
    REQUIRE(fewest * 3 < before.size());

    CollapseLog log(state);
    log.append(entries);
    // One step back around one triangle undoes a little; all steps around all triangles undo everything.
    std::vector<std::uint32_t> first_alive;
    for (std::uint32_t t = 0; first_alive.empty(); ++t)
        if (state.mesh.triangle_alive(t)) first_alive.push_back(t);
    const std::vector<std::uint32_t> changed = log.take_back(first_alive, 1);
    CHECK_FALSE(changed.empty());
    CHECK(alive(state.mesh).size() > fewest);
    CHECK(alive(state.mesh).size() < before.size() / 2);

    std::vector<std::uint32_t> all(sphere.triangles.size());
    for (std::uint32_t t = 0; t < all.size(); ++t) all[t] = t;
    log.take_back(all, std::numeric_limits<int>::max());
    CHECK(alive(state.mesh) == before);
    // The neighbourhoods are whole again, too, and no vertex stands for another any more.
    std::vector<CollapseMesh::Corner> around;
    std::size_t corners = 0;
    for (std::uint32_t v = 0; v < sphere.positions_mm.size(); ++v) {
        REQUIRE(state.mesh.alive(v));
        state.mesh.corners_around(v, around);
        for (const CollapseMesh::Corner c : around) CHECK(state.mesh.vertex(c) == v);
        corners += around.size();
    }
    CHECK(corners == 3 * sphere.triangles.size());
    for (const std::uint32_t first : state.first_sample) CHECK(first == CollapseMesh::kNone);
}

TEST_CASE("simplify: sheets closer than the tolerance do not meet", "[solidify]") {
    // A ball in a hollow a fiftieth larger: each moved by the tolerance they would pass through each other.
    const TriangleMesh nested = testing::joined(testing::make_icosphere(10.0, 5), testing::make_icosphere(10.2, 4));
    REQUIRE(find_self_intersections(nested).empty());
    const SimplifiedMesh few = simplify(nested, one_area(nested), {.tolerance_mm = 0.15, .block_mm = 8.0});
    CHECK(few.sound);
    CHECK(few.mesh.triangles.size() * 2 < nested.triangles.size());
    CHECK(find_self_intersections(few.mesh).empty());
    CHECK(report_mesh(few.mesh).closed_manifold());
}

TEST_CASE("color areas: a seam between two colours is none, a wide area between them is one", "[solidify]") {
    const TriangleMesh plate = testing::make_square(20.0, 40);
    const double seam = GENERATE(0.8, 8.0);
    const auto color_at = [&](const Vec3& p) {
        return p.x() < 10.0 - seam / 2   ? Rgb8{200, 40, 40}
               : p.x() < 10.0 + seam / 2 ? Rgb8{120, 40, 120}
                                         : Rgb8{40, 40, 200};
    };
    std::vector<Rgb8> colors;
    for (const Vec3& p : plate.positions_mm) colors.push_back(color_at(p));
    const ColorAreas areas = cut_into_areas(
        plate, colors,
        [&](std::uint32_t a, std::uint32_t b, double share) {
            return color_at(plate.positions_mm[a] + share * (plate.positions_mm[b] - plate.positions_mm[a]));
        },
        {});
    CHECK(areas.palette.size() == (seam < 2.0 ? 2 : 3));
    // Cutting covers the same square, each part in its own colour.
    double area = 0.0, red = 0.0;
    for (std::size_t t = 0; t < areas.mesh.triangles.size(); ++t) {
        const auto& [a, b, c] = areas.mesh.triangles[t];
        const Vec3& at = areas.mesh.positions_mm[a];
        const double own = 0.5 * (areas.mesh.positions_mm[b] - at).cross(areas.mesh.positions_mm[c] - at).z();
        REQUIRE(own > 0.0);
        area += own;
        if (areas.palette[areas.areas.of_triangle[t]][0] > 160) red += own;
    }
    CHECK(area == Approx(400.0).epsilon(1e-5));
    CHECK(red == Approx(20.0 * (seam < 2.0 ? 10.0 : 10.0 - seam / 2)).margin(20.0 * (seam < 2.0 ? seam / 2 : 0.15)));
}

}  // namespace
}  // namespace fretwork
