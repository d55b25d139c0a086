#include "likeness/surface_windows.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/shell/voxelize.h"
#include "support/make_meshes.h"
#include "test_pictures.h"

namespace fretwork::likeness {
namespace {

using namespace fretwork::testing;

VoxelPyramid pyramid_of(const TriangleMesh& mesh, int resolution) {
    return build_pyramid(voxelize(mesh, {.resolution = resolution}), 1);
}

/// Frames that lay the picture flat, upright as seen from the side the normals point to.
TexelFrames flat_frames(const PyramidLevel& shell, double pixels_per_voxel, bool mirrored) {
    const Vec3f normal = shell.normals[0];
    const Vec3f right = Vec3f::UnitZ().cross(normal).normalized() * (mirrored ? -1.0F : 1.0F);
    const Vec3f down = right.cross(normal) * (mirrored ? -1.0F : 1.0F);
    const auto scale = static_cast<float>(pixels_per_voxel);
    TexelFrames frames;
    for (const Vec3f& p : shell.positions)
        frames.push_back({scale * right.dot(p), scale * down.dot(p), scale * right, scale * down});
    return frames;
}

double mean_distance_to(const PatternPicture& exemplar, const Windows& windows) {
    const PlacedWindows all = all_windows(exemplar);
    const WindowBasis basis = principal_basis(all.windows);
    double sum = 0.0;
    for (const Nearest& n : NearestWindows(all.windows, basis).nearest(windows)) sum += n.squared_distance;
    return sum / static_cast<double>(windows.rows());
}

/// What it costs a window to be read half a pixel beside: where only the phase differs, no window costs more.
double half_pixel_cost(const PatternPicture& exemplar) {
    const PatternPicture half =
        read_picture(exemplar, exemplar.width, exemplar.height, [](int x, int y) { return Vec2(x + 1.0, y + 1.0); });
    double sum = 0.0;
    for (std::size_t i = 0; i < half.pixels.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) {
            const double d = static_cast<double>(half.pixels[i][c] - exemplar.pixels[i][c]);
            sum += d * d / static_cast<double>(half.pixels.size());
        }
    return sum * kWindowSide * kWindowSide;
}

TEST_CASE("surface windows: a flat pattern gives windows of its exemplar, a mirrored one does not", "[likeness]") {
    const PatternPicture exemplar = builtin_picture("hooks", 64);
    // Slanted against the grid, so that voxel centres and window pixels differ.
    const TriangleMesh mesh = rotated(make_square(10, 2), Vec3(1, 0.3, 0.2), 1.0);
    const VoxelPyramid pyramid = pyramid_of(mesh, 48);
    const PyramidLevel& shell = pyramid.levels[0];
    constexpr double pixels_per_voxel = 1.7;  // of the frames; the windows are at one voxel

    const auto mean_distance = [&](bool mirrored) {
        const ShownPattern pattern{flat_frames(shell, pixels_per_voxel, mirrored), pixels_per_voxel, {}, {}};
        const std::vector<Windows> windows = surface_windows(shell, pattern, exemplar, 200, 2, 1);
        REQUIRE(windows.size() == 2);
        REQUIRE(windows[0].rows() > 50);
        return mean_distance_to(exemplar, windows[0]);
    };
    const double upright = mean_distance(false);
    CHECK(mean_distance(true) > 2 * upright);
    CHECK(upright < half_pixel_cost(exemplar));
}

TEST_CASE("surface windows: a picture rolled around a cylinder gives windows of the picture", "[likeness]") {
    const PatternPicture exemplar = builtin_picture("hooks", 64);
    const double radius = 128 / (2 * std::numbers::pi);  // two pictures around, at one pixel per unit
    const TriangleMesh mesh = revolve({{radius, 0}, {radius, 38}}, 96, false);
    const VoxelPyramid pyramid = pyramid_of(mesh, 41);
    const PyramidLevel& shell = pyramid.levels[0];
    Vec3f middle = Vec3f::Zero();
    for (const Vec3f& p : shell.positions) middle += p / static_cast<float>(shell.size());
    ShownPattern pattern;
    for (const Vec3f& p : shell.positions) {
        const Vec3f out = Vec3f(p.x() - middle.x(), p.y() - middle.y(), 0);
        const Vec3f right = Vec3f::UnitZ().cross(out.normalized());
        const float turn = std::atan2(out.y(), out.x()) / (2 * std::numbers::pi_v<float>);
        pattern.frames.push_back({128 * turn, -p.z(), right, -Vec3f::UnitZ()});
    }
    const std::vector<Windows> windows = surface_windows(shell, pattern, exemplar, 300, 2, 1);
    REQUIRE(windows[0].rows() > 100);
    CHECK(mean_distance_to(exemplar, windows[0]) < half_pixel_cost(exemplar));
}

TEST_CASE("surface windows: none reaches over an open border", "[likeness]") {
    const VoxelPyramid pyramid = pyramid_of(make_square(10, 2), 12);
    ShownPattern pattern;
    pattern.frames.assign(pyramid.levels[0].size(), TexelFrame{0, 0, Vec3f::UnitX(), -Vec3f::UnitY()});
    const PatternPicture exemplar = cells_picture(32);
    // 14 voxels on a square of 12.
    CHECK(surface_windows(pyramid.levels[0], pattern, exemplar, 100, 2, 1)[0].rows() == 0);
    const auto some = surface_windows(pyramid.levels[0], pattern, exemplar, 100, 1, 1)[0].rows();
    // Middles may lie in the inner 6 x 6 of 12 x 12, a quarter, or within the voxel that a walk may miss.
    CHECK(some > 10);
    CHECK(some < 60);
}

TEST_CASE("surface windows: show what is laid over the pattern", "[likeness]") {
    const PatternPicture exemplar = stripes_picture(16, 16, 16, 1, true);
    using Over = ShownPattern::Over;
    ShownPattern pattern{TexelFrames(4, TexelFrame{}),
                         1.0,
                         {Over::kNothing, Over::kPaint, Over::kSolid, Over::kEmpty},
                         {0.1F, 0.2F, 0.3F, 1.0F}};
    const PatternPixel own = exemplar.read(0, 0);
    const auto with_solid = [&](float solid) { return PatternPixel{own[0], own[1], own[2], solid}; };
    CHECK(pattern.at(exemplar, 0, Vec3f::Zero()) == own);
    CHECK(pattern.at(exemplar, 1, Vec3f::Zero()) == pattern.paint);
    CHECK(pattern.at(exemplar, 2, Vec3f::Zero()) == with_solid(1.0F));
    CHECK(pattern.at(exemplar, 3, Vec3f::Zero()) == with_solid(0.0F));
}

TEST_CASE("surface windows: a walk on a sphere goes the way of its length and keeps its frame",
          "[likeness][property]") {
    constexpr double radius_voxels = 24.0;
    const VoxelPyramid pyramid = pyramid_of(make_icosphere(10, 5), 48);
    const PyramidLevel& shell = pyramid.levels[0];
    Vec3f center = Vec3f::Zero();
    for (const Vec3f& p : shell.positions) center += p / static_cast<float>(shell.size());
    for (std::size_t v = 0; v < shell.size(); v += 97) {
        CAPTURE(v);
        const Vec3f n = shell.normals[v], right = n.unitOrthogonal(), down = right.cross(n);
        const float length = 20.0F;
        SurfacePoint at{static_cast<VoxelIndex>(v), Vec3f::Zero(), right, down};
        for (int i = 0; i < 20; ++i) at = walk(shell, at, 1.0F, 0.0F);
        const Vec3f there = shell.positions[at.voxel] + at.beside - center, here = shell.positions[v] - center;
        const double arc = radius_voxels * std::acos(static_cast<double>(there.normalized().dot(here.normalized())));
        CHECK(arc == Approx(static_cast<double>(length)).epsilon(0.05));
        // Along a great circle, so that the frame's down is still at right angles to the circle's plane.
        CHECK(at.down.dot(down) > 0.97F);
        CHECK(std::abs(at.right.dot(shell.normals[at.voxel])) < 1e-3F);
    }
}

}  // namespace
}  // namespace fretwork::likeness
