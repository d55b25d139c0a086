#include "core/synthesis/texel_map.h"

#include <Eigen/Geometry>

#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "core/synthesis/choice.h"
#include "core/synthesis/plane_set.h"
#include "core/synthesis/plane_transforms.h"

namespace fretwork {
namespace {

Vec3f random_point(std::mt19937& rng, float reach) {
    std::uniform_real_distribution<float> u(-reach, reach);
    return {u(rng), u(rng), u(rng)};
}

struct Side {
    int width, height;
    double scale;
};

TEST_CASE("texel map: M is the affine map it stands for, at any size and scale", "[synthesis][property]") {
    const Side side =
        GENERATE(Side{128, 128, 1}, Side{37, 91, 1}, Side{1024, 8, 0.5}, Side{100, 300, 7.5}, Side{5, 5, 0.1});
    CAPTURE(side.width, side.height, side.scale);
    std::mt19937 rng{7};
    const PlaneSet planes(50, Vec3f::UnitZ());
    const TexelMap map(side.width, side.height, side.scale);
    const PlaneTransforms transforms(planes, 360, map);
    for (int trial = 0; trial < 200; ++trial) {
        const LinearIndex linear = static_cast<LinearIndex>(rng() % (50 * 360));
        const LinearPart part = transforms.linear_part(linear);
        const Label label{linear, static_cast<std::uint32_t>(rng())};
        const Vec3f p = random_point(rng, 1000), q = p + random_point(rng, 20);
        const TexelPosition at_p = texel_at(map, part, label.origin, to_fixed(p));
        const TexelPosition at_q = texel_at(map, part, label.origin, to_fixed(q));
        // One label: the difference of two positions is u.(q - p), modulo the period; 2^-12 voxel of
        // rounding in each of the points.
        const double du = static_cast<double>(static_cast<std::int32_t>(at_q.u - at_p.u)) / 4294967296.0 * side.width;
        const double dv = static_cast<double>(static_cast<std::int32_t>(at_q.v - at_p.v)) / 4294967296.0 * side.height;
        const double slack = 1e-3 * side.scale + 1e-4;
        CHECK(std::fabs(std::remainder(du - static_cast<double>(map.u_vector(part).dot(q - p)), side.width)) < slack);
        CHECK(std::fabs(std::remainder(dv - static_cast<double>(map.v_vector(part).dot(q - p)), side.height)) < slack);
    }
}

TEST_CASE("texel map: offsets of a level lead where positions lead", "[synthesis][property]") {
    const int level = GENERATE(0, 3, 7);
    std::mt19937 rng{3};
    const PlaneSet planes(300, Vec3f::UnitZ());
    const TexelMap map(128, 96, 1.0);
    const PlaneTransforms transforms(planes, 1024, map);
    const float cell = std::ldexp(1.0F, level);
    for (int trial = 0; trial < 200; ++trial) {
        const LinearPart part = transforms.linear_part(static_cast<LinearIndex>(rng() % (300 * 1024)));
        const Vec3f d = random_point(rng, 3);
        const auto fixed = [](float x) { return static_cast<std::int32_t>(std::lround(x * 4096.0F)); };
        const LevelOffset offset{pack16(fixed(d.x()), fixed(d.y())), pack16(fixed(d.z()), 0)};
        const TexelPosition step = map.project(part, offset, level);
        const double du = static_cast<double>(static_cast<std::int32_t>(step.u)) / 4294967296.0 * 128;
        const double dv = static_cast<double>(static_cast<std::int32_t>(step.v)) / 4294967296.0 * 96;
        const double slack = 1e-3 * static_cast<double>(cell);
        CHECK(std::fabs(std::remainder(du - static_cast<double>(map.u_vector(part).dot(cell * d)), 128)) < slack);
        CHECK(std::fabs(std::remainder(dv - static_cast<double>(map.v_vector(part).dot(cell * d)), 96)) < slack);
    }
}

TEST_CASE("texel map: vectors of a transform span the plane, have the asked length and do not mirror", "[synthesis]") {
    const PlaneSet planes(40, Vec3f(1, 2, 3));
    const TexelMap map(128, 200, 1.5);
    const PlaneTransforms transforms(planes, 64, map);
    for (LinearIndex i = 0; i < 40 * 64; ++i) {
        const LinearPart part = transforms.linear_part(i);
        const Vec3f u = map.u_vector(part), v = map.v_vector(part), n = planes.normal(transforms.plane_of(i));
        REQUIRE(u.norm() == Approx(1.5).epsilon(1e-3));
        REQUIRE(v.norm() == Approx(1.5).epsilon(1e-3));
        REQUIRE(std::fabs(u.dot(v)) < 5e-3F);
        REQUIRE(std::fabs(u.dot(n)) < 5e-3F);
        // Rows run downwards: right x up = normal.
        REQUIRE(u.cross(-v).normalized().dot(n) > 0.999F);
        REQUIRE(transforms.up_of(i).dot(-v) == Approx(1.5).epsilon(1e-3));
    }
}

TEST_CASE("texel map: every pixel of an odd size gets an equal share of the period", "[synthesis]") {
    const TexelMap map(37, 91, 1.0);
    std::vector<int> columns(37, 0), rows(91, 0);
    for (std::uint32_t t = 0; t < 65536; ++t) {
        ++columns.at(map.column(t << 16));
        ++rows.at(map.row(t << 16));
    }
    for (const int c : columns) CHECK(std::abs(c - 65536 / 37) <= 1);
    for (const int r : rows) CHECK(std::abs(r - 65536 / 91) <= 1);
}

TEST_CASE("plane set: nearest is nearest", "[synthesis][property]") {
    const int count = GENERATE(6, 26, 300, 1000);
    const PlaneSet planes(count, Vec3f::UnitZ());
    REQUIRE(planes.size() == static_cast<std::size_t>(count));
    std::mt19937 rng{11};
    for (int trial = 0; trial < 3000; ++trial) {
        const Vec3f d = random_point(rng, 1).normalized();
        float best = -1;
        for (PlaneIndex p = 0; p < planes.size(); ++p) best = std::max(best, planes.normal(p).dot(d));
        REQUIRE(planes.normal(planes.nearest(d)).dot(d) == best);
    }
}

TEST_CASE("plane set: frames are right-handed and lean to the asked up", "[synthesis]") {
    const PlaneSet planes(26, Vec3f::UnitZ());
    for (PlaneIndex p = 0; p < planes.size(); ++p) {
        CHECK((planes.right(p).cross(planes.up(p)) - planes.normal(p)).norm() < 1e-5F);
        CHECK(planes.up(p).z() >= -1e-6F);
    }
    // The 26 directions to the neighbours of a voxel.
    for (const Vec3f& d : {Vec3f(0, 0, 1), Vec3f(-1, 0, 0), Vec3f(1, 1, 0), Vec3f(-1, 1, -1)})
        CHECK((planes.normal(planes.nearest(d)) - d.normalized()).norm() < 1e-6F);
}

TEST_CASE("plane transforms: the rotation towards a direction is the best there is", "[synthesis][property]") {
    const PlaneSet planes(30, Vec3f::UnitZ());
    const PlaneTransforms transforms(planes, 128, TexelMap(64, 64, 1.0));
    std::mt19937 rng{5};
    for (int trial = 0; trial < 500; ++trial) {
        const auto plane = static_cast<PlaneIndex>(rng() % 30);
        Vec3f up = random_point(rng, 1);
        up -= up.dot(planes.normal(plane)) * planes.normal(plane);
        const Vec3f found = transforms.up_of(transforms.index(plane, transforms.rotation_towards(plane, up)));
        // Half a step of 1/128 turn, and the error of the arc tangent.
        CHECK(std::acos(std::min(1.0F, found.dot(up.normalized()))) < 0.5F * 0.0491F + 2e-3F);
    }
}

}  // namespace
}  // namespace fretwork
