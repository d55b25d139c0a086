#include "core/pipeline/intended_use.h"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/base/error.h"
#include "core/shell/voxelize.h"
#include "support/block_mesh.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

/// A table 40 x 20 x 20 mm: a top on four legs.
const TriangleMesh& table() {
    static const TriangleMesh mesh =
        block_mesh({{{{0, 4, 36, 40}, {0, 4, 16, 20}, {0, 16, 20}}}, {{{2, 8, 2}, {2, 6, 2}, {8, 2}}}},
                   [](const std::array<int, 3>& block) {
                       const bool leg = block[0] != 1 && block[1] != 1;
                       return block[2] == 1 || leg ? Block::solid() : Block::empty();
                   });
    return mesh;
}

const SurfaceVoxels& shell() {
    static const SurfaceVoxels voxels = voxelize(table(), {.resolution = 40});
    return voxels;
}

ForceProfile use(const Settings& settings) {
    return intended_use(table(), shell(), settings);
}

Settings gravity() {
    Settings settings;
    settings.structure.profile = LoadProfile::kGravity;
    return settings;
}

TEST_CASE("intended use: a drop is one more case, so many times the weight", "[loads]") {
    Settings settings = gravity();
    REQUIRE(use(settings).cases.size() == 1);
    settings.structure.gravity = Vec3(0, 3, -4);
    settings.structure.drop_factor = 30.0;
    const ForceProfile dropped = use(settings);
    REQUIRE(dropped.cases.size() == 2);
    CHECK((dropped.cases[0].acceleration_g - Vec3(0, 0.6, -0.8)).norm() < 1e-12);
    CHECK((dropped.cases[1].acceleration_g - 30.0 * dropped.cases[0].acceleration_g).norm() < 1e-12);
    CHECK(dropped.cases[1].name == "drop");
    CHECK(dropped.cases[1].fixed == dropped.cases[0].fixed);

    // Energy: m g (h + s) = F s.
    settings.structure.drop_factor.reset();
    settings.structure.drop_height_mm = 500.0;
    settings.structure.drop_stop_mm = 4.0;
    CHECK(use(settings).cases[1].acceleration_g.norm() == Approx(504.0 / 4.0));
    settings.structure.drop_factor = 30.0;
    CHECK_THROWS_WITH(use(settings), Catch::Contains("drop_factor = 30") && Catch::Contains("126"));

    Settings paper = gravity();
    paper.structure.steps.rules = ReinforceRules::kPaper;
    paper.structure.drop_factor = 2.0;
    for (const LoadCase& load_case : use(paper).cases) CHECK(load_case.constant_per_sample);
}

TEST_CASE("intended use: a force along the normals is a pressure of that much in all", "[loads]") {
    Settings settings;
    const Region top{"top", BoxRegion{Vec3(-1, -1, 19.5), Vec3(41, 21, 21)}};
    settings.loads.push_back({top, "press", Vec3::Zero(), 0.0, 24.0});
    settings.loads.push_back({{"point", SphereRegion{Vec3(20, 10, 20), 3.0}}, "point", Vec3(0, 0, -5), 0.25, 0.0});
    const ForceProfile profile = use(settings);
    REQUIRE(profile.cases.size() == 2);
    const PatchLoad& press = profile.cases[0].loads.at(0);
    Vec3 pushed = Vec3::Zero();
    double along_normals = 0.0;
    for (const VoxelIndex v : press.voxels) {
        along_normals += press.pressure_mpa * static_cast<double>(shell().area_mm2[v]);
        pushed -= press.pressure_mpa * static_cast<double>(shell().area_mm2[v]) * shell().normals[v].cast<double>();
    }
    CHECK(along_normals == Approx(24.0));
    // All but its rim faces upwards.
    CHECK(pushed[2] < -0.8 * 24.0);
    CHECK(std::abs(pushed[0]) + std::abs(pushed[1]) < 0.1);
    const PatchLoad& point = profile.cases[1].loads.at(0);
    CHECK(point.force_n == Vec3(0, 0, -5));
    CHECK(point.pressure_mpa == 0.25);
    for (const VoxelIndex v : point.voxels) CHECK((shell().points_mm[v] - Vec3(20, 10, 20)).norm() < 3.0 + 1e-9);
    CHECK(point.voxels.size() > 10);
}

TEST_CASE("intended use: taking a support away is the use of the object without it", "[loads]") {
    Settings settings = gravity();
    settings.structure.remove_supports = true;
    const ForceProfile feet = use(settings);
    REQUIRE(feet.cases.size() == 5);
    std::set<std::string> names;
    for (std::size_t c = 1; c < 5; ++c) {
        names.insert(feet.cases[c].name);
        CHECK(feet.cases[c].acceleration_g == feet.cases[0].acceleration_g);
        CHECK(std::ranges::includes(feet.cases[0].fixed, feet.cases[c].fixed));
        CHECK(static_cast<double>(feet.cases[c].fixed.size()) ==
              Approx(0.75 * static_cast<double>(feet.cases[0].fixed.size())).epsilon(0.1));
    }
    CHECK(names.size() == 4);
    CHECK(names.contains("gravity, without foot at (2, 2, 1) mm"));

    const auto leg = [](const char* name, double x, double y) {
        return FixtureOption{{name, BoxRegion{Vec3(x - 3, y - 3, -1), Vec3(x + 3, y + 3, 1)}}, ""};
    };
    settings.fixtures = {leg("near", 2, 2), leg("far", 38, 18)};
    settings.structure.drop_factor = 10.0;
    const ForceProfile fixed = use(settings);
    REQUIRE(fixed.cases.size() == 6);
    Settings without = settings;
    without.structure.remove_supports = false;
    std::erase_if(without.fixtures, [](const FixtureOption& f) { return f.region.name == "near"; });
    const ForceProfile rest = use(without);
    REQUIRE(fixed.cases[2].name == "gravity, without near");
    CHECK(fixed.cases[2].fixed == rest.cases[0].fixed);
    REQUIRE(fixed.cases[4].name == "drop, without near");
    CHECK(fixed.cases[4].fixed == rest.cases[1].fixed);
    CHECK(fixed.cases[4].acceleration_g == rest.cases[1].acceleration_g);

    // What holds alone cannot be taken away.
    settings.fixtures.pop_back();
    CHECK_THROWS_AS(use(settings), ConstraintsNotMet);
}

TEST_CASE("intended use: fixtures hold under every profile, in the cases that they name", "[loads]") {
    Settings settings = gravity();
    settings.structure.drop_factor = 10.0;
    settings.fixtures.push_back({{"top", BoxRegion{Vec3(-1, -1, 19), Vec3(41, 21, 21)}}, "drop"});
    const ForceProfile profile = use(settings);
    const auto highest = [](const LoadCase& load_case) {
        double z = 0.0;
        for (const VoxelIndex v : load_case.fixed) z = std::max(z, shell().points_mm[v][2]);
        return z;
    };
    CHECK(highest(profile.cases[0]) < 4.0);
    CHECK(highest(profile.cases[1]) > 19.0);
    settings.fixtures[0].load_case = "shake";
    CHECK_THROWS_WITH(use(settings), Catch::Contains("'shake'"));
}

TEST_CASE("intended use: grips stand beside the cases of the profile, held as they are", "[loads]") {
    Settings settings = gravity();
    settings.structure.grips = 6;
    settings.structure.handling_force_n = 25.0;
    const ForceProfile profile = use(settings);
    REQUIRE(profile.cases.size() == 7);
    CHECK(profile.cases[0].name == "gravity");
    for (std::size_t c = 1; c < 7; ++c) {
        CHECK(profile.cases[c].name.starts_with("grip at ("));
        CHECK(profile.cases[c].fixed == profile.cases[0].fixed);
        CHECK(profile.cases[c].loads.at(0).force_n.norm() == Approx(25.0));
    }
    const TriangleMesh sheet = make_square(40.0, 8);
    CHECK_THROWS_WITH(intended_use(sheet, voxelize(sheet, {.resolution = 40}), settings),
                      Catch::Contains("structure.grips = 6"));
}

}  // namespace
}  // namespace fretwork
