#include "core/shell/voxelize.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/shell/components.h"
#include "core/shell/triangle_cells.h"
#include "shell_fixtures.h"

namespace fretwork {
namespace {

using namespace testing;

VoxelCoord voxel_holding(const VoxelGrid& grid, const Vec3& p_mm) {
    const Vec3 q = (p_mm - grid.origin_mm) / grid.voxel_mm;
    return {static_cast<int>(std::floor(q[0])), static_cast<int>(std::floor(q[1])), static_cast<int>(std::floor(q[2]))};
}

// Distance to a triangle, which may be degenerate.
double distance_to(const TriangleMesh& mesh, const Triangle& triangle, const Vec3& p) {
    const Corners c = {mesh.positions_mm[triangle[0]], mesh.positions_mm[triangle[1]], mesh.positions_mm[triangle[2]]};
    const Vec3 n = (c[1] - c[0]).cross(c[2] - c[0]);
    double best = std::numeric_limits<double>::infinity();
    bool inside = n.norm() > 0.0;
    for (std::size_t k = 0; k < 3; ++k) {
        const Vec3& a = c[k];
        const Vec3 ab = c[(k + 1) % 3] - a;
        const double t = ab.squaredNorm() > 0.0 ? std::clamp(ab.dot(p - a) / ab.squaredNorm(), 0.0, 1.0) : 0.0;
        best = std::min(best, (p - a - t * ab).norm());
        inside = inside && n.dot(ab.cross(p - a)) >= 0.0;
    }
    return inside ? std::abs(n.normalized().dot(p - c[0])) : best;
}

TEST_CASE("voxelize: every entry has a unit normal, a point in its cell and a triangle that holds the point",
          "[shell][property]") {
    for (const auto& [name, mesh] : assorted_meshes()) {
        CAPTURE(name);
        const SurfaceVoxels shell = voxelize(mesh, {.resolution = 30});
        for (std::size_t v = 0; v < shell.size(); ++v) {
            REQUIRE(std::abs(shell.normals[v].norm() - 1.0F) < 1e-5F);
            const Vec3 in_cell = (shell.points_mm[v] - shell.grid.center_mm(shell.coords[v])) / shell.grid.voxel_mm;
            REQUIRE(in_cell.cwiseAbs().maxCoeff() < 0.5 + 1e-6);
            REQUIRE(distance_to(mesh, mesh.triangles[shell.triangles[v]], shell.points_mm[v]) <
                    1e-6 * shell.grid.voxel_mm + 1e-12);
        }
    }
}

TEST_CASE("voxelize: degenerate triangles take their normal from what is around them", "[shell]") {
    // A whisker without area on the rim of a square: a chain of cells outward from it.
    TriangleMesh mesh = make_square(8.0);
    mesh.positions_mm.emplace_back(16, 0, 0);
    mesh.triangles.push_back({0, 1, static_cast<std::uint32_t>(mesh.positions_mm.size() - 1)});
    REQUIRE(mesh.positions_mm[0] == Vec3(0, 0, 0));
    REQUIRE(mesh.positions_mm[1] == Vec3(8, 0, 0));
    const SurfaceVoxels shell = voxelize(mesh, {.resolution = 16});
    CHECK(shell.coords[16] == VoxelCoord{16, 0, 0});
    for (const Vec3f& n : shell.normals) CHECK(n == Vec3f(0, 0, 1));
    // Nothing around at all: a segment.
    mesh.triangles = {{0, 1, 1}};
    const SurfaceVoxels segment = voxelize(mesh, {.resolution = 16});
    CHECK(segment.size() == 17);
    for (const Vec3f& n : segment.normals) CHECK(n == Vec3f(0, 0, 1));
}

TEST_CASE("voxelize: a flat square becomes one layer", "[shell]") {
    const SurfaceVoxels shell = voxelize(make_square(16.0), {.resolution = 16});
    CHECK(shell.grid.voxel_mm == 1.0);
    REQUIRE(shell.size() == 17u * 17u);  // 16 mm plus half a voxel of margin on each side
    for (std::size_t v = 0; v < shell.size(); ++v) {
        CAPTURE(v);
        CHECK(shell.coords[v][2] == 0);
        CHECK(shell.normals[v] == Vec3f(0, 0, 1));
        CHECK(shell.points_mm[v][2] == 0.0);
        CHECK(shell.components[v] == 0);
    }
}

TEST_CASE("voxelize: sphere normals point away from the centre and points lie on the surface", "[shell]") {
    const double radius_mm = 20.0;
    const SurfaceVoxels shell = voxelize(make_sphere(radius_mm, 24, 48), {.resolution = 24});
    // The surface inside a voxel lies within half a diagonal of its centre, so its normal turns by at most that
    // length over the radius; the facets themselves add half their opening angle.
    const double half_diagonal_mm = 0.5 * std::sqrt(3.0) * shell.grid.voxel_mm;
    const double max_angle = 2 * half_diagonal_mm / radius_mm + std::numbers::pi / 24;
    const double sagitta_mm = radius_mm * (1 - std::cos(std::numbers::pi / 24)) * 2;
    for (std::size_t v = 0; v < shell.size(); ++v) {
        CAPTURE(v);
        const Vec3 outward = shell.grid.center_mm(shell.coords[v]).normalized();
        CHECK(shell.normals[v].cast<double>().dot(outward) >= std::cos(max_angle));
        CHECK(std::abs(shell.normals[v].norm() - 1.0F) < 1e-6F);
        CHECK(shell.points_mm[v].norm() <= radius_mm + 1e-9);
        CHECK(shell.points_mm[v].norm() >= radius_mm - sagitta_mm);
        const Vec3 in_cell = (shell.points_mm[v] - shell.grid.center_mm(shell.coords[v])) / shell.grid.voxel_mm;
        CHECK(in_cell.cwiseAbs().maxCoeff() < 0.5 + 1e-6);
    }
}

TEST_CASE("voxelize: weights normals by the area inside the voxel", "[shell]") {
    // A 0.4 mm high wall stands on the floor along x = 8. A voxel on the fold is a 1 mm cube that holds 1 mm^2 of
    // floor (normal +z) and 0.4 mm^2 of wall (normal +x). Floor and wall share the line of vertices.
    TriangleMesh mesh;
    for (const double x : {0.0, 8.0, 16.0})
        for (const double y : {0.0, 16.0}) mesh.positions_mm.emplace_back(x, y, 0.0);
    mesh.positions_mm.emplace_back(8, 16, 0.4);
    mesh.positions_mm.emplace_back(8, 0, 0.4);
    for (const Triangle& t : {Triangle{0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}, {2, 3, 6}, {2, 6, 7}})
        mesh.triangles.push_back(t);
    const SurfaceVoxels shell = voxelize(mesh, {.resolution = 16});
    const auto on_fold = std::find(shell.coords.begin(), shell.coords.end(), VoxelCoord{8, 5, 0});
    REQUIRE(on_fold != shell.coords.end());
    const auto v = static_cast<std::size_t>(on_fold - shell.coords.begin());
    CHECK((shell.normals[v] - Vec3f(0.4F, 0, 1).normalized()).norm() < 1e-6F);
    CHECK(shell.area_mm2[v] == Approx(1.4F));
}

TEST_CASE("voxelize: selects the voxels the surface touches and no others", "[shell][property]") {
    const auto seed = GENERATE(range(1u, 7u));
    CAPTURE(seed);
    const TriangleMesh mesh = random_soup(seed, 12, 30.0);
    const SurfaceVoxels shell = voxelize(mesh, {.resolution = 8});
    const std::set<VoxelCoord> selected(shell.coords.begin(), shell.coords.end());

    // Oracle: sample every triangle on a lattice. No point of a triangle is farther than `slack` from a sample, so
    // a touched voxel, grown by `slack`, holds at least one.
    constexpr int steps = 60;
    std::set<VoxelCoord> touched;
    std::set<VoxelCoord> nearly_touched;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions_mm[t[0]];
        const Vec3 ab = mesh.positions_mm[t[1]] - a;
        const Vec3 ac = mesh.positions_mm[t[2]] - a;
        const double slack = (ab.norm() + ac.norm()) / steps;
        for (int i = 0; i <= steps; ++i)
            for (int j = 0; i + j <= steps; ++j) {
                const Vec3 p = a + (i * ab + j * ac) / steps;
                touched.insert(voxel_holding(shell.grid, p));
                for (int corner = 0; corner < 8; ++corner)
                    nearly_touched.insert(voxel_holding(
                        shell.grid, p + slack * Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1)));
            }
    }
    CHECK(std::ranges::includes(selected, touched));
    CHECK(std::ranges::includes(nearly_touched, selected));
}

TEST_CASE("voxelize: the areas of all entries add up to the surface", "[shell][property]") {
    for (const auto& [name, mesh] : assorted_meshes()) {
        CAPTURE(name);
        const SurfaceVoxels shell = voxelize(mesh, {.resolution = 40});
        double sum = 0.0;
        for (const float a : shell.area_mm2) sum += static_cast<double>(a);
        CHECK(sum == Approx(area_mm2(mesh)).epsilon(1e-5));
        // Seen along the normal an area is no larger; the centre of all is that of the mesh.
        Vec3 moment = Vec3::Zero(), expected = Vec3::Zero();
        for (std::size_t v = 0; v < shell.size(); ++v) {
            CHECK(shell.facing_area_mm2[v] <= shell.area_mm2[v] * (1.0F + 1e-5F));
            moment += static_cast<double>(shell.area_mm2[v]) *
                      (shell.grid.origin_mm + shell.grid.voxel_mm * shell.centroids_voxels[v].cast<double>());
        }
        for (const Triangle& t : mesh.triangles) {
            const Vec3 &a = mesh.positions_mm[t[0]], &b = mesh.positions_mm[t[1]], &c = mesh.positions_mm[t[2]];
            expected += 0.5 * (b - a).cross(c - a).norm() * (a + b + c) / 3.0;
        }
        CHECK((moment - expected).norm() < 1e-4 * shell.grid.voxel_mm * (1.0 + sum) * 40);
    }
}

TEST_CASE("voxelize: the facing area is the length of the sum of areas", "[shell]") {
    // In a flat wall all of it, around the edge of a box less.
    const SurfaceVoxels shell = voxelize(make_box({0, 0, 0}, {10, 10, 10}), {.resolution = 10});
    std::size_t flat = 0, bent = 0;
    for (std::size_t v = 0; v < shell.size(); ++v) {
        const float share = shell.facing_area_mm2[v] / shell.area_mm2[v];
        const bool along_axis = shell.normals[v].cwiseAbs().maxCoeff() > 0.999F;
        ++(along_axis ? flat : bent);
        if (along_axis) CHECK(share == Approx(1.0F));
        if (!along_axis) CHECK(share < 0.8F);
    }
    CHECK(flat > 100);
    CHECK(bent > 50);
}

TEST_CASE("voxelize: where two sides of a wall cancel, the one listed first gives the normal", "[shell]") {
    // A fin of zero thickness: one sheet folded along its top, z = 16. Only the cells of the fold join the sides.
    TriangleMesh mesh;
    mesh.positions_mm = {{0, 0, 0}, {16, 0, 0}, {16, 0, 16}, {0, 0, 16}, {0, 0, 0}, {16, 0, 0}};
    const std::vector<Triangle> front = {{0, 1, 2}, {0, 2, 3}};  // normal -y
    const std::vector<Triangle> back = {{3, 2, 5}, {3, 5, 4}};   // normal +y
    for (const bool front_first : {true, false}) {
        mesh.triangles = front_first ? front : back;
        const std::vector<Triangle>& other = front_first ? back : front;
        mesh.triangles.insert(mesh.triangles.end(), other.begin(), other.end());
        const SurfaceVoxels shell = voxelize(mesh, {.resolution = 16});
        REQUIRE(shell.size() == 16u * 17u * 2u + 17u);
        for (std::size_t v = 0; v < shell.size(); ++v) {
            CAPTURE(v);
            CHECK(std::abs(shell.normals[v][1]) == Approx(1.0F));
            if (shell.coords[v][2] == 16) CHECK(shell.normals[v][1] == Approx(front_first ? -1.0F : 1.0F));
        }
    }
}

TEST_CASE("voxelize: coordinates do not depend on the order of the triangles", "[shell][property]") {
    const auto seed = GENERATE(range(1u, 5u));
    CAPTURE(seed);
    for (const TriangleMesh& mesh :
         {random_soup(seed, 12, 30.0), make_torus(9, 2.5, 32, 16), make_thin_plate(9, 9, 0.1)}) {
        const SurfaceVoxels before = voxelize(mesh, {.resolution = 24});
        const SurfaceVoxels after = voxelize(shuffled(mesh, seed), {.resolution = 24});
        CHECK(before.coords == after.coords);
        CHECK(before.adjacency.neighbor.size() == after.adjacency.neighbor.size());
    }
}

TEST_CASE("voxelize: lists voxels by z, then y, then x, repeated for each sheet by its lowest triangle", "[shell]") {
    for (const TriangleMesh& mesh : {make_sphere(5.0, 16, 32), make_thin_plate(9, 9, 0.1)}) {
        const SurfaceVoxels shell = voxelize(mesh, {.resolution = 16});
        for (std::size_t v = 1; v < shell.size(); ++v) {
            CAPTURE(v);
            VoxelCoord before = shell.coords[v - 1];
            VoxelCoord after = shell.coords[v];
            std::ranges::reverse(before);
            std::ranges::reverse(after);
            REQUIRE(before <= after);
        }
    }
    // The plate's bottom comes first in the mesh or its top does; either way the first listed is that one.
    const TriangleMesh plate = make_thin_plate(9, 9, 0.1);
    const SurfaceVoxels shell = voxelize(plate, {.resolution = 16});
    std::size_t doubled = 0;
    for (std::size_t v = 1; v < shell.size(); ++v)
        if (shell.coords[v] == shell.coords[v - 1]) {
            ++doubled;
            CHECK(shell.triangles[v - 1] < shell.triangles[v]);
        }
    CHECK(doubled > 100);
}

TEST_CASE("voxelize: the outer faces of a box take one layer each at any size", "[shell][property]") {
    for (const double height : {3.0, 3.1, 3.3, 3.5, 3.77, 3.99}) {
        CAPTURE(height);
        const SurfaceVoxels shell = voxelize(make_box({0, 0, 0}, {20, 20, height}), {.resolution = 20});
        std::set<int> layers;
        for (const VoxelCoord& c : shell.coords)
            if (c[0] > 2 && c[0] < 17 && c[1] > 2 && c[1] < 17) layers.insert(c[2]);
        CHECK(layers.size() == 2);
        // Every corner of the box is at least a quarter of a voxel inside the grid.
        CHECK(shell.grid.origin_mm[2] <= -0.25 + 1e-12);
        CHECK(shell.grid.origin_mm[2] + shell.grid.extent[2] >= height + 0.25 - 1e-12);
    }
}

TEST_CASE("voxelize: with halvings, the cells that hold a voxel of the full grid and no others", "[shell][property]") {
    for (const auto& [name, mesh] : assorted_meshes()) {
        for (const int resolution : {30, 41}) {
            const SurfaceVoxels full = voxelize(mesh, {.resolution = resolution});
            for (const int halvings : {1, 2}) {
                CAPTURE(name, resolution, halvings);
                const SurfaceVoxels coarse = voxelize(mesh, {.resolution = resolution, .halvings = halvings});
                CHECK(coarse.grid.origin_mm == full.grid.origin_mm);
                CHECK(coarse.grid.voxel_mm == full.grid.voxel_mm * (1 << halvings));
                std::set<VoxelCoord> expected;
                for (const VoxelCoord& c : full.coords)
                    expected.insert({c[0] >> halvings, c[1] >> halvings, c[2] >> halvings});
                CHECK(std::set<VoxelCoord>(coarse.coords.begin(), coarse.coords.end()) == expected);
            }
        }
    }
}

TEST_CASE("voxelize: gives the same shell on any number of threads", "[shell][property]") {
    for (const TriangleMesh& mesh :
         {make_icosphere(10, 4), make_box({0, 0, 0}, {10, 9, 8}), make_thin_plate(9, 9, 0.1)}) {
        SurfaceVoxels reference;
        for (const int threads : {1, 2, 5}) {
            const ThreadLimit limit(threads);
            const SurfaceVoxels shell = voxelize(mesh, {.resolution = 100});
            if (threads == 1) reference = shell;
            CHECK(shell.coords == reference.coords);
            CHECK(shell.normals == reference.normals);
            CHECK(shell.points_mm == reference.points_mm);
            CHECK(shell.triangles == reference.triangles);
            CHECK(shell.area_mm2 == reference.area_mm2);
            CHECK(shell.components == reference.components);
            CHECK(shell.adjacency.first == reference.adjacency.first);
            CHECK(shell.adjacency.neighbor == reference.adjacency.neighbor);
            CHECK(shell.adjacency.length_voxels == reference.adjacency.length_voxels);
        }
    }
}

TEST_CASE("voxelize: rejects what it cannot voxelize", "[shell]") {
    CHECK_THROWS_AS(voxelize({}), InvalidInput);
    CHECK_THROWS_AS(voxelize(make_square(0.0)), InvalidInput);
    CHECK_THROWS_AS(voxelize(make_square(1e200)), InvalidInput);
    CHECK_THROWS_AS(voxelize(make_square(1e-200)), InvalidInput);
    for (const int resolution : {-1, 0, 3, 2049})
        CHECK_THROWS_AS(voxelize(make_square(1.0), {resolution}), InvalidSetting);
    CHECK_NOTHROW(voxelize(make_square(1.0), {4}));

    TriangleMesh dangling = make_square(1.0);
    dangling.triangles[0][2] = 99;
    CHECK_THROWS_AS(voxelize(dangling), InvalidInput);

    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        TriangleMesh not_finite = make_square(1.0);
        not_finite.positions_mm[0][1] = bad;
        CHECK_THROWS_AS(voxelize(not_finite), InvalidInput);
    }
}

TEST_CASE("voxelize: stops when asked and reports progress in order", "[shell]") {
    std::stop_source source;
    double last = -1.0;
    const RunControl run(
        [&](std::string_view, double fraction) {
            CHECK(fraction >= last);
            last = fraction;
        },
        source.get_token());
    voxelize(make_sphere(5.0, 32, 64), {.resolution = 16}, run);
    CHECK(last == 1.0);

    // In the middle of a run, after any of its steps.
    for (const double at : {0.0, 0.05, 0.4, 0.7, 0.85}) {
        std::stop_source later;
        const RunControl stopping(
            [&](std::string_view, double fraction) {
                if (fraction >= at) later.request_stop();
            },
            later.get_token());
        CHECK_THROWS_AS(voxelize(make_sphere(5.0, 32, 64), {.resolution = 16}, stopping), Cancelled);
    }
    source.request_stop();
    CHECK_THROWS_AS(voxelize(make_square(1.0), {}, run), Cancelled);
}

}  // namespace
}  // namespace fretwork
