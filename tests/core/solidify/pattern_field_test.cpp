#include "core/solidify/pattern_field.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/error.h"
#include "core/shell/voxelize.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

/// Upright stripes: solid where x mod period < half of it. One pixel column is one unit of distance.
Exemplar stripes(int period_px) {
    Exemplar e;
    e.width = e.height = period_px;
    e.tileable = true;
    for (int y = 0; y < period_px; ++y)
        for (int x = 0; x < period_px; ++x) {
            const bool solid = x < period_px / 2;
            e.solid.push_back(solid ? 1 : 0);
            e.color.push_back(solid ? Rgb8{10, 20, 30} : Rgb8{250, 250, 250});
            const double center = x + 0.5, half = 0.5 * period_px;
            const double to_border = std::min({center, std::abs(center - half), period_px - center});
            e.feature_distance_px.push_back(static_cast<float>(solid ? -to_border : to_border));
        }
    return e;
}

/// Frames that lay the exemplar flat on z = 0 with its columns along `across`.
TexelFrames flat_frames(const SurfaceVoxels& shell, const Vec3& across, double pixels_per_voxel) {
    TexelFrames frames(shell.size());
    const Vec3 along(-across.y(), across.x(), 0.0);
    for (std::size_t v = 0; v < shell.size(); ++v) {
        const Vec3 p = shell.points_mm[v] / shell.grid.voxel_mm;
        frames[v].u = static_cast<float>(p.dot(across) * pixels_per_voxel);
        frames[v].v = static_cast<float>(p.dot(along) * pixels_per_voxel);
        frames[v].du = (across * pixels_per_voxel).cast<float>();
        frames[v].dv = (along * pixels_per_voxel).cast<float>();
    }
    return frames;
}

/// Signed distance of x to stripes, in the unit of `period`.
double stripe_distance(double x, double period) {
    const double inside = x - period * std::floor(x / period), half = 0.5 * period;
    const double to_border = std::min({inside, std::abs(inside - half), period - inside});
    return inside < half ? -to_border : to_border;
}

TEST_CASE("pattern field: follows the labels below the voxel scale", "[solidify]") {
    const TriangleMesh plate = testing::make_square(40.0);
    const SurfaceVoxels shell = voxelize(plate, {.resolution = 40});
    const GeodesicLinks links = link_two_rings(shell);
    const double voxel = shell.grid.voxel_mm, angle = 0.3, period_voxels = 8.0, pixels = 4.0;
    const Vec3 across(std::cos(angle), std::sin(angle), 0.0);
    const Exemplar exemplar = stripes(static_cast<int>(period_voxels * pixels));
    const TexelFrames frames = flat_frames(shell, across, pixels);
    SolidStates solid(shell.size());
    for (std::size_t v = 0; v < shell.size(); ++v)
        solid[v] = stripe_distance(shell.points_mm[v].dot(across) / voxel, period_voxels) < 0.0 ? SolidState::kSolid
                                                                                                : SolidState::kEmpty;
    const RegionField keep(plate, {});
    const PatternField field(plate, shell, links, solid, frames, exemplar, keep);
    for (double y = 5.0; y < 35.0; y += 0.37)
        for (double x = 5.0; x < 35.0; x += 0.41) {
            const double truth = stripe_distance(Vec3(x, y, 0.0).dot(across) / voxel, period_voxels);
            if (std::abs(truth) > 1.0) continue;
            CAPTURE(x, y);
            REQUIRE(field.signed_distance_voxels(Vec3(x, y, 0.0), 0) == Approx(truth).margin(0.15));
        }
    CHECK(field.color(Vec3(20.0, 20.0, 0.0), 0)[0] <= 10);
}

TEST_CASE("pattern field: where the states overrule the labels the border has no stairs", "[solidify]") {
    const TriangleMesh plate = testing::make_square(50.0);
    const SurfaceVoxels shell = voxelize(plate, {.resolution = 50});
    const GeodesicLinks links = link_two_rings(shell);
    const double voxel = shell.grid.voxel_mm;
    const double angle = GENERATE(0.1, 0.35, 0.7);
    // A bridge of five voxels across an exemplar that says something else everywhere.
    const Vec3 across(-std::sin(angle), std::cos(angle), 0.0);
    const auto truth = [&](const Vec3& p) { return std::abs((p - Vec3(25, 25, 0)).dot(across)) / voxel - 2.5; };
    SolidStates solid(shell.size());
    for (std::size_t v = 0; v < shell.size(); ++v)
        solid[v] = truth(shell.points_mm[v]) < 0.0 ? SolidState::kSolid : SolidState::kEmpty;
    const Exemplar exemplar = stripes(8);
    const TexelFrames frames = flat_frames(shell, Vec3::UnitX(), 1.0);
    const RegionField keep(plate, {});
    const PatternField field(plate, shell, links, solid, frames, exemplar, keep);
    // Width across the bridge, and the position of one border, along its middle.
    double narrowest = 1e9, widest = 0.0;
    const Vec3 along(std::cos(angle), std::sin(angle), 0.0);
    for (double s = -12.0; s <= 12.0; s += 0.25) {
        double width = 0.0;
        for (double h = -5.0; h < 5.0; h += 0.02)
            if (field.signed_distance_voxels(Vec3(25, 25, 0) + s * along + h * across * voxel, 0) < 0.0) width += 0.02;
        narrowest = std::min(narrowest, width);
        widest = std::max(widest, width);
    }
    CHECK(narrowest > 4.3);
    CHECK(widest < 5.7);
}

TEST_CASE("pattern field: kept regions have their own clean border", "[solidify]") {
    const TriangleMesh plate = testing::make_square(40.0);
    const SurfaceVoxels shell = voxelize(plate, {.resolution = 40});
    const GeodesicLinks links = link_two_rings(shell);
    const RegionField keep(plate, {{"disc", SphereRegion{Vec3(20.3, 19.8, 0.0), 7.2}}});
    SolidStates solid(shell.size(), SolidState::kEmpty);
    for (std::size_t v = 0; v < shell.size(); ++v)
        if (keep.signed_distance_mm(shell.points_mm[v], 0) < 0.0) solid[v] = SolidState::kSolid;
    Exemplar exemplar = stripes(8);
    std::fill(exemplar.feature_distance_px.begin(), exemplar.feature_distance_px.end(), 3.0F);
    const TexelFrames frames = flat_frames(shell, Vec3::UnitX(), 1.0);
    const PatternField field(plate, shell, links, solid, frames, exemplar, keep);
    for (double a = 0.0; a < 6.28; a += 0.05) {
        const Vec3 direction(std::cos(a), std::sin(a), 0.0);
        CHECK(field.signed_distance_voxels(Vec3(20.3, 19.8, 0.0) + 7.15 * direction, 0) < 0.0);
        CHECK(field.signed_distance_voxels(Vec3(20.3, 19.8, 0.0) + 7.25 * direction, 0) > 0.0);
    }
}

TEST_CASE("pattern field: needs one state and one frame per voxel", "[solidify]") {
    const TriangleMesh plate = testing::make_square(10.0);
    const SurfaceVoxels shell = voxelize(plate, {.resolution = 10});
    const GeodesicLinks links = link_two_rings(shell);
    const Exemplar exemplar = stripes(8);
    const RegionField keep(plate, {});
    CHECK_THROWS_AS(PatternField(plate, shell, links, {}, TexelFrames(shell.size()), exemplar, keep), InvalidInput);
    CHECK_THROWS_AS(PatternField(plate, shell, links, SolidStates(shell.size()), {}, exemplar, keep), InvalidInput);
}

}  // namespace
}  // namespace fretwork
