#include "core/synthesis/orientation_field.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <stop_token>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "synthesis_fixtures.h"

namespace fretwork {
namespace {

using namespace testing;

double angle_deg(const Vec3f& a, const Vec3f& b) {
    return std::acos(std::clamp(static_cast<double>(a.dot(b)), -1.0, 1.0)) * 180 / std::numbers::pi;
}

TEST_CASE("orientation field: without smoothing it is the projection", "[synthesis]") {
    const PyramidCase c = sphere_case(24);
    const Vec3f direction = Vec3f(1, -2, 0.5).normalized();
    const auto fields = orientation_fields(c.pyramid, 2, {.direction = 3.0F * direction});
    REQUIRE(fields.size() == 2);
    for (std::size_t l = 0; l < 2; ++l)
        for (std::size_t v = 0; v < c.pyramid.levels[l].size(); ++v) {
            const Vec3f& n = c.pyramid.levels[l].normals[v];
            const Vec3f projected = direction - direction.dot(n) * n;
            if (projected.norm() > 0.01F) REQUIRE(angle_deg(fields[l].direction[v], projected.normalized()) < 0.1);
        }
}

TEST_CASE("orientation field: smoothed, it is tangent, unit, and follows the direction where that is clear",
          "[synthesis]") {
    const bool symmetric = GENERATE(false, true);
    const PyramidCase c = sphere_case(48);
    const auto fields = orientation_fields(c.pyramid, 3, {Vec3f::UnitZ(), symmetric, 4.0});
    for (std::size_t l = 0; l < fields.size(); ++l)
        for (std::size_t v = 0; v < fields[l].direction.size(); ++v) {
            const Vec3f &n = c.pyramid.levels[l].normals[v], &d = fields[l].direction[v];
            if (fields[l].certainty[v] <= 0.0F) continue;
            REQUIRE(std::fabs(d.norm() - 1.0F) < 1e-4F);
            REQUIRE(std::fabs(d.dot(n)) < 1e-3F);
            REQUIRE(fields[l].certainty[v] <= 1.0F);
            if (l > 0 || std::fabs(n.z()) > 0.5F) continue;
            const Vec3f up = (Vec3f::UnitZ() - n.z() * n).normalized();
            const double angle = angle_deg(d, up);
            // By symmetry the exact field points up everywhere; the voxels' normals are off by some degrees.
            REQUIRE((symmetric ? std::min(angle, 180 - angle) : angle) < 12);
        }
}

TEST_CASE("orientation field: neighbours agree across a lid where the direction says nothing", "[synthesis]") {
    // The top of a slab leaning by 6 degrees: the bare projection onto its top is short, and the four
    // sides disagree. Smoothed, at most the voxels around a singularity may turn fast.
    const PyramidCase c = pyramid_of(make_box({0, 0, 0}, {12, 12, 4}), 48);
    const auto smooth = orientation_fields(c.pyramid, 1, {Vec3f(0.1F, 0, 1), false, 8.0})[0];
    std::size_t sharp = 0, pairs = 0;
    const PyramidLevel& level = c.pyramid.levels[0];
    for (VoxelIndex v = 0; v < level.size(); ++v)
        for (const VoxelIndex w : level.adjacency.of(v)) {
            if (level.normals[v].dot(level.normals[w]) < 0.99F) continue;
            ++pairs;
            if (smooth.direction[v].dot(smooth.direction[w]) < 0.7F) ++sharp;
        }
    CHECK(sharp < pairs / 200);
}

TEST_CASE("orientation field: the same for any number of threads, and stops when asked", "[synthesis]") {
    const PyramidCase c = sphere_case(32);
    const OrientationFieldSettings settings{Vec3f::UnitZ(), false, 3.0};
    const auto many = orientation_fields(c.pyramid, 2, settings);
    {
        const ThreadLimit limit(1);
        const auto one = orientation_fields(c.pyramid, 2, settings);
        for (std::size_t l = 0; l < 2; ++l) {
            CHECK(one[l].direction == many[l].direction);
            CHECK(one[l].certainty == many[l].certainty);
        }
    }
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(orientation_fields(c.pyramid, 2, settings, RunControl(nullptr, source.get_token())), Cancelled);
}

}  // namespace
}  // namespace fretwork
