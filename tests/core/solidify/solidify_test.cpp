#include "core/solidify/solidify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/closest_point.h"
#include "core/mesh/mesh_report.h"
#include "core/shell/voxelize.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using Formula = std::function<double(const Vec3&)>;

constexpr Rgb8 kRed = {200, 30, 30}, kBlue = {30, 30, 200};

PatternField pattern_of(const Formula& distance_voxels) {
    return PatternField([distance_voxels](const Vec3& p, std::uint32_t) { return distance_voxels(p); },
                        [](const Vec3& p, std::uint32_t) { return p.z() < 0.0 ? kRed : kBlue; });
}

Formula no_holes() {
    return [](const Vec3&) { return -10.0; };
}

/// Round holes on a cubic raster.
Formula round_holes(double period_mm, double radius_mm, double voxel_mm) {
    return [=](const Vec3& p) {
        Vec3 d = p + Vec3(0.3, 0.2, 0.1) * period_mm;
        for (int k = 0; k < 3; ++k) d[k] = std::remainder(d[k], period_mm);
        return (radius_mm - d.norm()) / voxel_mm;
    };
}

/// A band of the gyroid.
Formula gyroid(double period_mm, double voxel_mm) {
    return [=](const Vec3& p) {
        const double k = 2.0 * std::numbers::pi / period_mm;
        const double g = std::sin(k * p.x()) * std::cos(k * p.y()) + std::sin(k * p.y()) * std::cos(k * p.z()) +
                         std::sin(k * p.z()) * std::cos(k * p.x());
        return (std::abs(g) - 0.6) / (1.2 * k * voxel_mm);
    };
}

struct Model {
    std::string name;
    TriangleMesh mesh;
    std::size_t components = 1;
    bool open = false;
};

std::vector<Model> models() {
    return {
        {"sphere", testing::make_icosphere(10.0, 4)},
        {"torus", testing::make_torus(9.0, 4.0, 48, 24)},
        {"box", testing::make_box(Vec3(-8, -7, -9), Vec3(8, 7, 9))},
        {"bracket", testing::scaled(testing::make_bracket(), 0.4)},
        {"thin plate", testing::make_thin_plate(20.0, 20.0, 1.5)},
        {"open bowl", testing::make_open_bowl(10.0, 16, 32), 1, true},
        {"two parts",
         testing::joined(testing::make_icosphere(5.0, 3),
                         testing::translated(testing::make_icosphere(6.0, 3), Vec3(13.0, 0.0, 0.0))),
         2},
        {"hollow", testing::make_nested_spheres(10.0, 3.5, 3), 2},
        {"crossing itself", testing::scaled(testing::make_overlapping_boxes(), 6.0), 2},
    };
}

/// Solid pieces: surface components that enclose material, that is, with a positive volume.
std::size_t solid_pieces(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> leader(mesh.positions_mm.size());
    for (std::uint32_t v = 0; v < leader.size(); ++v) leader[v] = v;
    const auto root = [&](std::uint32_t v) {
        while (leader[v] != v) v = leader[v] = leader[leader[v]];
        return v;
    };
    for (const Triangle& t : mesh.triangles) {
        leader[root(t[1])] = root(t[0]);
        leader[root(t[2])] = root(t[0]);
    }
    std::vector<double> volume(leader.size(), 0.0);
    for (const Triangle& t : mesh.triangles)
        volume[root(t[0])] += mesh.positions_mm[t[0]].dot(mesh.positions_mm[t[1]].cross(mesh.positions_mm[t[2]])) / 6.0;
    return static_cast<std::size_t>(std::count_if(volume.begin(), volume.end(), [](double v) { return v > 0.0; }));
}

void check_valid(const TriangleMesh& mesh) {
    const MeshReport report = report_mesh(mesh, CountSelfIntersections::kYes);
    CHECK(report.closed_manifold());
    CHECK(report.non_manifold_vertices == 0);
    CHECK(report.degenerate_triangles == 0);
    CHECK(report.duplicate_triangles == 0);
    CHECK(report.self_intersections == 0);
    CHECK(report.volume_mm3 > 0.0);
    bool as_float = true;
    for (const Vec3& p : mesh.positions_mm)
        for (int k = 0; k < 3; ++k) as_float = as_float && static_cast<double>(static_cast<float>(p[k])) == p[k];
    CHECK(as_float);
}

TEST_CASE("solidify: every model, side and pattern gives a valid mesh, one piece per part", "[solidify][property]") {
    const Model model = GENERATE(from_range(models()));
    const WallSide side = GENERATE(WallSide::kInward, WallSide::kOutward, WallSide::kCentred);
    if (model.open && side != WallSide::kCentred) return;
    CAPTURE(model.name, static_cast<int>(side));
    const SurfaceVoxels shell = voxelize(model.mesh, {.resolution = 22});
    const double voxel = shell.grid.voxel_mm;
    // Unsimplified on one side, which is the harder case for rounding; simplified on the others.
    const SolidifySettings settings{2.6 * voxel, side, side == WallSide::kCentred ? 0.0 : 0.1, 0};
    for (const Formula& formula :
         {no_holes(), round_holes(7.0 * voxel, 2.4 * voxel, voxel), gyroid(12.0 * voxel, voxel)}) {
        const CarvedMesh carved = solidify(model.mesh, shell, pattern_of(formula), settings);
        check_valid(carved.mesh);
        CHECK(carved.triangle_colors.size() == carved.mesh.triangles.size());
        CHECK(carved.triangle_voxels.size() == carved.mesh.triangles.size());
        // Outward walls of near parts, and parts that overlap, may grow together.
        CHECK(solid_pieces(carved.mesh) <= model.components);
        if (model.name != "crossing itself" && model.name != "two parts")
            CHECK(solid_pieces(carved.mesh) == model.components);
    }
}

TEST_CASE("solidify: an uncarved shell has the volume of the shell", "[solidify]") {
    const double tolerance = GENERATE(0.0, 0.1);
    SECTION("sphere") {
        const double radius = 10.0;
        const TriangleMesh sphere = testing::make_icosphere(radius, 5);
        const SurfaceVoxels shell = voxelize(sphere, {.resolution = 40});
        const auto ball = [](double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; };
        const double t = 1.5;
        const auto volume = [&](WallSide side) {
            return testing::volume_mm3(solidify(sphere, shell, pattern_of(no_holes()), {t, side, tolerance, 0}).mesh);
        };
        CHECK(volume(WallSide::kInward) == Approx(ball(radius) - ball(radius - t)).epsilon(0.02));
        CHECK(volume(WallSide::kOutward) == Approx(ball(radius + t) - ball(radius)).epsilon(0.02));
        CHECK(volume(WallSide::kCentred) == Approx(ball(radius + t / 2) - ball(radius - t / 2)).epsilon(0.02));
    }
    SECTION("box") {
        const TriangleMesh box = testing::make_box(Vec3::Zero(), Vec3(12, 14, 16));
        const SurfaceVoxels shell = voxelize(box, {.resolution = 32});
        const double t = 2.0;
        const CarvedMesh carved = solidify(box, shell, pattern_of(no_holes()), {t, WallSide::kInward, tolerance, 0});
        CHECK(testing::volume_mm3(carved.mesh) == Approx(12.0 * 14 * 16 - 8.0 * 10 * 12).epsilon(0.005));
    }
}

TEST_CASE("solidify: outer vertices lie on the input, inner ones a wall below it", "[solidify]") {
    const TriangleMesh torus = testing::make_torus(9.0, 4.0, 64, 32);
    const SurfaceVoxels shell = voxelize(torus, {.resolution = 48});
    const double voxel = shell.grid.voxel_mm, t = 3.0 * voxel;
    const CarvedMesh carved = solidify(torus, shell, pattern_of(no_holes()), {t, WallSide::kInward, 0.0, 0});
    const SurfaceTree tree(torus);
    std::size_t outer = 0, inner = 0, inexact = 0;
    for (const Vec3& p : carved.mesh.positions_mm) {
        const double d = tree.closest(p).distance_mm / voxel;
        if (d < 1.0) {
            ++outer;
            REQUIRE(d <= 2e-3);
        } else {
            ++inner;
            // Folds of the offset face, where facets meet, are found to a tenth of a voxel, the rest exactly.
            REQUIRE(std::abs(d - 3.0) < 0.1);
            if (std::abs(d - 3.0) > 5e-3) ++inexact;
        }
    }
    CHECK(outer > 1000);
    CHECK(inner > 1000);
    CHECK(inexact * 20 < inner);
}

TEST_CASE("solidify: flat faces stay flat and sharp edges sharp", "[solidify]") {
    const double tolerance = GENERATE(0.0, 0.1);
    const Vec3 low(0, 0, 0), high(12, 14, 16);
    const TriangleMesh box = testing::make_box(low, high);
    const SurfaceVoxels shell = voxelize(box, {.resolution = 32});
    const CarvedMesh carved = solidify(box, shell, pattern_of(no_holes()), {2.0, WallSide::kInward, tolerance, 0});
    // Area of all triangles that lie in one of the six planes: chamfers would take from it.
    double flat_area = 0.0;
    for (const Triangle& t : carved.mesh.triangles) {
        const Vec3 &a = carved.mesh.positions_mm[t[0]], &b = carved.mesh.positions_mm[t[1]],
                   &c = carved.mesh.positions_mm[t[2]];
        for (int k = 0; k < 3; ++k)
            for (const double plane : {low[k], high[k]})
                if (std::max({std::abs(a[k] - plane), std::abs(b[k] - plane), std::abs(c[k] - plane)}) < 5e-3)
                    flat_area += 0.5 * (b - a).cross(c - a).norm();
    }
    CHECK(flat_area == Approx(2.0 * (12 * 14 + 14 * 16 + 12 * 16)).epsilon(0.005));
}

TEST_CASE("solidify: holes have the drawn size on both faces, and clean rims", "[solidify]") {
    // A flat plate with one round hole: every vertex near the hole lies on the cylinder or on a face.
    const TriangleMesh plate = testing::make_box(Vec3(-10, -10, -3), Vec3(10, 10, 3));
    const SurfaceVoxels shell = voxelize(plate, {.resolution = 32});
    const double voxel = shell.grid.voxel_mm, radius = 5.0, t = 2.0;
    const CarvedMesh carved =
        solidify(plate, shell, pattern_of([=](const Vec3& p) { return (radius - std::hypot(p.x(), p.y())) / voxel; }),
                 {t, WallSide::kInward, 0.0, 0});
    check_valid(carved.mesh);
    std::size_t rim = 0, near = 0, astray = 0;
    for (const Vec3& p : carved.mesh.positions_mm) {
        const double r = std::hypot(p.x(), p.y());
        if (r > 7.0) continue;
        const double off_wall = std::abs(r - radius);
        const double off_face = std::min(std::abs(std::abs(p.z()) - 3.0), std::abs(std::abs(p.z()) - 1.0));
        CAPTURE(p.x(), p.y(), p.z());
        REQUIRE(std::min(off_wall, off_face) < 0.6 * voxel);
        ++near;
        if (std::min(off_wall, off_face) > 0.02 * voxel) ++astray;
        if (std::max(off_wall, off_face) < 0.02 * voxel) ++rim;
    }
    // Corners that could not be moved out of their lattice cell safely.
    CHECK(astray * 15 < near);
    // Four rims of 2 pi r, with more than one vertex per voxel each.
    CHECK(static_cast<double>(rim) > 4.0 * 2.0 * std::numbers::pi * radius / voxel);
}

TEST_CASE("solidify: simplifying moves nothing farther than the tolerance", "[solidify]") {
    const TriangleMesh sphere = testing::make_icosphere(10.0, 5);
    const SurfaceVoxels shell = voxelize(sphere, {.resolution = 40});
    const double voxel = shell.grid.voxel_mm;
    const PatternField pattern = pattern_of(round_holes(6.0, 2.0, voxel));
    const CarvedMesh fine = solidify(sphere, shell, pattern, {2.0, WallSide::kInward, 0.0, 0});
    const CarvedMesh coarse = solidify(sphere, shell, pattern, {2.0, WallSide::kInward, 0.1, 0});
    CHECK(coarse.mesh.triangles.size() * 4 < fine.mesh.triangles.size());
    const SurfaceTree coarse_tree(coarse.mesh);
    double farthest = 0.0;
    for (const Vec3& p : fine.mesh.positions_mm) farthest = std::max(farthest, coarse_tree.closest(p).distance_mm);
    CHECK(farthest <= 0.1 * voxel * 1.1);

    const std::size_t target = coarse.mesh.triangles.size() / 2;
    const CarvedMesh few = solidify(sphere, shell, pattern, {2.0, WallSide::kInward, 0.1, target});
    CHECK(few.mesh.triangles.size() <= target);
    check_valid(few.mesh);
}

TEST_CASE("solidify: triangles carry the colour and the voxel of their place", "[solidify]") {
    const TriangleMesh sphere = testing::make_icosphere(10.0, 4);
    const SurfaceVoxels shell = voxelize(sphere, {.resolution = 30});
    const CarvedMesh carved = solidify(sphere, shell, pattern_of(no_holes()), {2.0, WallSide::kInward, 0.1, 0});
    for (std::size_t i = 0; i < carved.mesh.triangles.size(); ++i) {
        const Triangle& t = carved.mesh.triangles[i];
        const Vec3 center =
            (carved.mesh.positions_mm[t[0]] + carved.mesh.positions_mm[t[1]] + carved.mesh.positions_mm[t[2]]) / 3.0;
        if (std::abs(center.z()) > 0.5) CHECK(carved.triangle_colors[i] == (center.z() < 0.0 ? kRed : kBlue));
        const Vec3& voxel_point = shell.points_mm[carved.triangle_voxels[i]];
        CHECK((voxel_point - center.normalized() * 10.0).norm() < 2.0 * shell.grid.voxel_mm);
    }
}

TEST_CASE("solidify: a border between colours runs where it was drawn", "[solidify]") {
    const TriangleMesh sphere = testing::make_icosphere(10.0, 4);
    const SurfaceVoxels shell = voxelize(sphere, {.resolution = 30});
    const double voxel = shell.grid.voxel_mm;
    const CarvedMesh carved = solidify(sphere, shell, pattern_of(no_holes()), {2.0, WallSide::kInward, 0.1, 0});
    // Simplified triangles span several voxels, yet none reaches a voxel over the border.
    double longest = 0.0;
    std::size_t red = 0;
    for (std::size_t i = 0; i < carved.mesh.triangles.size(); ++i) {
        const Triangle& t = carved.mesh.triangles[i];
        const bool is_red = carved.triangle_colors[i] == kRed;
        if (!is_red) REQUIRE(carved.triangle_colors[i] == kBlue);
        red += is_red ? 1 : 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& p = carved.mesh.positions_mm[t[k]];
            longest = std::max(longest, (p - carved.mesh.positions_mm[t[(k + 1) % 3]]).norm());
            CHECK((is_red ? p.z() : -p.z()) < voxel);
        }
    }
    CHECK(longest > 3.0 * voxel);
    CHECK(2 * red == Approx(carved.mesh.triangles.size()).epsilon(0.2));
}

TEST_CASE("solidify: loose pieces go and are counted", "[solidify]") {
    const TriangleMesh sphere = testing::make_icosphere(10.0, 4);
    const SurfaceVoxels shell = voxelize(sphere, {.resolution = 30});
    const double voxel = shell.grid.voxel_mm;
    // A ring-shaped hole near the top cuts a cap off.
    const CarvedMesh carved =
        solidify(sphere, shell, pattern_of([=](const Vec3& p) { return (1.0 - std::abs(p.z() - 7.0)) / voxel; }),
                 {2.0, WallSide::kInward, 0.0, 0});
    CHECK(carved.islands_removed == 1);
    CHECK(carved.islands_volume_mm3 > 50.0);
    for (const Vec3& p : carved.mesh.positions_mm) REQUIRE(p.z() < 6.5);
}

TEST_CASE("solidify: a small closed hollow is filled, a large one stays", "[solidify]") {
    // A disc of less than two walls, solid through, with a bulge in the middle that leaves a lens between its walls.
    const double wall = 2.4;
    const TriangleMesh bulged =
        testing::revolve({{0, -4}, {3, -3.5}, {7, -2}, {24, -2}, {24, 2}, {7, 2}, {3, 3.5}, {0, 4}}, 64, false);
    const SurfaceVoxels shell = voxelize(bulged, {.resolution = 60});
    const CarvedMesh disc = solidify(bulged, shell, pattern_of(no_holes()), {.thickness_mm = wall});
    CHECK(disc.hollows_filled == 1);
    const MeshReport report = report_mesh(disc.mesh);
    CHECK(report.components == 1);
    CHECK(report.volume_mm3 == Approx(testing::volume_mm3(bulged)).epsilon(0.01));

    const TriangleMesh ball = testing::make_icosphere(10.0, 4);
    const CarvedMesh hollow =
        solidify(ball, voxelize(ball, {.resolution = 32}), pattern_of(no_holes()), {.thickness_mm = wall});
    CHECK(hollow.hollows_filled == 0);
    CHECK(report_mesh(hollow.mesh).components == 2);
}

TEST_CASE("solidify: the same for any number of threads", "[solidify]") {
    const TriangleMesh torus = testing::make_torus(9.0, 4.0, 48, 24);
    const SurfaceVoxels shell = voxelize(torus, {.resolution = 36});
    const PatternField pattern = pattern_of(gyroid(8.0, shell.grid.voxel_mm));
    CarvedMesh first;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        CarvedMesh carved = solidify(torus, shell, pattern, {2.0, WallSide::kInward, 0.1, 0});
        if (threads == 1) first = carved;
        CHECK(carved.mesh.positions_mm == first.mesh.positions_mm);
        CHECK(carved.mesh.triangles == first.mesh.triangles);
        CHECK(carved.triangle_colors == first.triangle_colors);
        CHECK(carved.triangle_voxels == first.triangle_voxels);
    }
}

TEST_CASE("solidify: says what cannot be met", "[solidify]") {
    const TriangleMesh sphere = testing::make_icosphere(10.0, 3);
    const SurfaceVoxels shell = voxelize(sphere, {.resolution = 20});
    const PatternField solid = pattern_of(no_holes());
    CHECK_THROWS_AS(solidify(sphere, shell, solid, {1.0, WallSide::kInward, 0.1, 0}), ConstraintsNotMet);
    CHECK_THROWS_WITH(solidify(sphere, shell, solid, {1.0, WallSide::kInward, 0.1, 0}),
                      Catch::Contains("thickness_mm = 1 mm") && Catch::Contains("resolution to"));
    CHECK_THROWS_AS(solidify(sphere, shell, solid, {-1.0, WallSide::kInward, 0.1, 0}), InvalidSetting);
    CHECK_THROWS_AS(solidify(sphere, shell, solid, {3.0, WallSide::kInward, 2.0, 0}), InvalidSetting);
    CHECK_THROWS_AS(
        solidify(sphere, shell, pattern_of([](const Vec3&) { return 5.0; }), {3.0, WallSide::kInward, 0.1, 0}),
        ConstraintsNotMet);
    CHECK_THROWS_AS(solidify({}, {}, solid, {}), InvalidInput);
    const TriangleMesh bowl = testing::make_open_bowl(10.0, 16, 32);
    const SurfaceVoxels bowl_shell = voxelize(bowl, {.resolution = 20});
    CHECK_THROWS_AS(solidify(bowl, bowl_shell, solid, {3.0, WallSide::kInward, 0.1, 0}), ConstraintsNotMet);
    CHECK_THROWS_AS(solidify(bowl, bowl_shell, solid, {3.0, WallSide::kOutward, 0.1, 0}), ConstraintsNotMet);
}

TEST_CASE("solidify: stops when asked and reports progress in order", "[solidify]") {
    const TriangleMesh sphere = testing::make_icosphere(10.0, 3);
    const SurfaceVoxels shell = voxelize(sphere, {.resolution = 24});
    const PatternField solid = pattern_of(no_holes());
    double last = 0.0;
    solidify(sphere, shell, solid, {3.0, WallSide::kInward, 0.1, 0}, RunControl([&](std::string_view, double fraction) {
                 CHECK(fraction >= last);
                 last = fraction;
             }));
    CHECK(last == 1.0);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(
        solidify(sphere, shell, solid, {3.0, WallSide::kInward, 0.1, 0}, RunControl(nullptr, source.get_token())),
        Cancelled);
}

}  // namespace
}  // namespace fretwork
