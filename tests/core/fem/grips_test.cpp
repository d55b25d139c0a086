#include "core/fem/grips.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/shell/voxelize.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

Vec3 middle(const SurfaceVoxels& shell, const PatchLoad& patch) {
    Vec3 sum = Vec3::Zero();
    for (const VoxelIndex v : patch.voxels) sum += shell.points_mm[v];
    return sum / static_cast<double>(patch.voxels.size());
}

TEST_CASE("grips: the two fingers leave no force and no moment", "[fem][loads][property]") {
    const int body = GENERATE(0, 1, 2, 3);
    CAPTURE(body);
    const TriangleMesh mesh = body == 0   ? make_icosphere(20.0, 4)
                              : body == 1 ? make_box(Vec3::Zero(), Vec3(40, 30, 20))
                              : body == 2 ? make_torus(20.0, 6.0, 48, 24)
                                          : make_cylinder(10.0, 40.0, 48, 12);
    const SurfaceVoxels shell = voxelize(mesh, {.resolution = 48});
    const std::vector<LoadCase> grips = grip_cases(shell, 12, 30.0);
    CHECK(grips.size() >= 5);
    CHECK(grips.size() <= 12);
    for (const LoadCase& grip : grips) {
        REQUIRE(grip.loads.size() == 2);
        Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
        for (const PatchLoad& finger : grip.loads) {
            CHECK(finger.force_n.norm() == Approx(30.0));
            CHECK(finger.pressure_mpa == 0.0);
            CHECK(finger.voxels.size() > 5);
            for (const VoxelIndex v : finger.voxels) {
                const Vec3 share = finger.force_n / static_cast<double>(finger.voxels.size());
                force += share;
                moment += shell.points_mm[v].cross(share);
                CHECK((shell.points_mm[v] - middle(shell, finger)).norm() < 10.0);
            }
        }
        CHECK(force.norm() < 1e-9);
        CHECK(moment.norm() < 1e-7);
        // They push into the body, towards each other.
        const Vec3 way = middle(shell, grip.loads[1]) - middle(shell, grip.loads[0]);
        CHECK(grip.loads[0].force_n.dot(way) > 0.0);
        for (const PatchLoad& finger : grip.loads) {
            Vec3 normal = Vec3::Zero();
            for (const VoxelIndex v : finger.voxels) normal += shell.normals[v].cast<double>();
            CHECK(normal.normalized().dot(finger.force_n.normalized()) < -0.8);
        }
    }
}

TEST_CASE("grips: a ball is held across its middle, each grip elsewhere", "[fem][loads]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(20.0, 5), {.resolution = 64});
    const std::vector<LoadCase> grips = grip_cases(shell, 8, 10.0);
    REQUIRE(grips.size() == 8);
    for (std::size_t i = 0; i < grips.size(); ++i) {
        const Vec3 a = middle(shell, grips[i].loads[0]), b = middle(shell, grips[i].loads[1]);
        CHECK((a - b).norm() > 36.0);
        CHECK((a + b).norm() < 2.0);
        for (std::size_t j = 0; j < i; ++j) {
            const Vec3 other = middle(shell, grips[j].loads[0]);
            CHECK(std::min((a - other).norm(), (a + other).norm()) > 2.0);
        }
    }
}

TEST_CASE("grips: what has one side only cannot be pinched", "[fem][loads]") {
    const SurfaceVoxels sheet = voxelize(make_square(40.0, 8), {.resolution = 48});
    CHECK(grip_cases(sheet, 8, 10.0).empty());
    CHECK(grip_cases(voxelize(make_icosphere(20.0, 4), {.resolution = 48}), 0, 10.0).empty());
}

}  // namespace
}  // namespace fretwork
