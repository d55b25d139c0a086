#include "core/pipeline/strength_check.h"

#include <array>
#include <catch2/catch.hpp>
#include <vector>

#include "core/base/error.h"
#include "support/block_mesh.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

StrengthCheckSettings settings_at(int resolution) {
    StrengthCheckSettings settings;
    settings.analysis.material = material_by_name("PLA");
    settings.resolution = resolution;
    return settings;
}

TEST_CASE("strength check: keeps to the memory by larger voxels, and says so", "[strength]") {
    const TriangleMesh ring = make_torus(20.0, 4.0, 48, 24);
    StrengthCheckSettings settings = settings_at(96);
    const StrengthCheck asked = check_own_weight(ring, 0.1, settings);
    CHECK_FALSE(asked.coarser);
    CHECK(asked.report.voxel_mm == Approx(48.0 / 96).epsilon(1e-3));
    CHECK(asked.report.cases.size() == 3);

    const std::uint64_t needed =
        memory_for(make_voxel_model(ring, asked.report.voxel_mm), 3) + asked.report.factor_bytes;
    settings.analysis.max_memory_bytes = needed / 2;
    const StrengthCheck coarser = check_own_weight(ring, 0.1, settings);
    CHECK(coarser.coarser);
    CHECK(coarser.asked_voxel_mm == asked.report.voxel_mm);
    CHECK(coarser.report.voxels < asked.report.voxels / 2);
    // Still the same ring.
    CHECK(coarser.report.volume_mm3 == Approx(asked.report.volume_mm3).epsilon(0.05));
    settings.analysis.max_memory_bytes = 1000;
    CHECK_THROWS_AS(check_own_weight(ring, 0.1, settings), MemoryLimit);
}

TEST_CASE("strength check: loads act alike through the model and through the carved surface", "[strength]") {
    // The file stands on its side, and in centimetres.
    const TriangleMesh post = make_box(Vec3::Zero(), Vec3(40, 4, 4), {20, 2, 2});
    TriangleMesh file = scaled(post, 0.1);
    Settings settings;
    settings.input.scale = 10.0;
    settings.structure.profile = LoadProfile::kOwn;
    settings.loads.push_back({{"end", BoxRegion{Vec3(39.9, -1, -1), Vec3(41, 5, 5)}}, "pull", Vec3(8, 0, 0), 0.0});
    settings.fixtures.push_back({{"foot", BoxRegion{Vec3(-1, -1, -1), Vec3(2, 5, 5)}}, ""});
    const SurfaceLoads by_model = loads_of_source(file, {}, settings, 80);
    const SurfaceLoads by_carved = loads_of_carved(post, settings, 80);
    StrengthCheckSettings fine = settings_at(80);
    fine.analysis.keep_fields = true;
    const StrengthReport a = check_strength(post, by_model, fine).report;
    const StrengthReport b = check_strength(post, by_carved, fine).report;
    for (const StrengthReport& report : {a, b}) {
        REQUIRE(report.cases.size() == 1);
        CHECK(report.cases[0].applied_n[0] == Approx(8.0));
        CHECK(report.cases[0].reaction_n[0] == Approx(-8.0));
    }
    // 8 N on 16 mm^2 in the middle of the post, whose weight (0.2 mN) is nothing beside it.
    const VoxelModel model = make_voxel_model(post, 0.5);
    for (std::size_t v = 0; v < model.voxels.size(); ++v)
        if (model.voxels[v] == VoxelCoord{45, 4, 4}) {
            CHECK(a.cases[0].stress_mpa[v][0] == Approx(0.5).epsilon(0.01));
            CHECK(b.cases[0].stress_mpa[v][0] == Approx(0.5).epsilon(0.01));
        }
}

TEST_CASE("strength check: a drop of n weights stresses n times as much, a taken support as if it were not there",
          "[strength][loads]") {
    const TriangleMesh plank = make_box(Vec3::Zero(), Vec3(40, 6, 3), {20, 3, 2});
    Settings settings;
    settings.structure.profile = LoadProfile::kGravity;
    settings.structure.drop_factor = 250.0;
    settings.structure.remove_supports = true;
    const auto end = [](const char* name, double from) {
        return FixtureOption{{name, BoxRegion{Vec3(from, -1, -1), Vec3(from + 2.0, 7, 4)}}, ""};
    };
    settings.fixtures = {end("left", -1.0), end("right", 39.0)};
    const StrengthCheckSettings fine = settings_at(80);
    const auto cases = [&](const Settings& of) {
        return check_strength(plank, loads_of_source(plank, {}, of, 80), fine).report.cases;
    };
    const std::vector<StrengthCase> found = cases(settings);
    REQUIRE(found.size() == 6);
    for (const std::size_t weight : {0u, 2u, 3u}) {
        const StrengthCase& dropped = found[weight == 0 ? 1 : weight + 2];
        CHECK(dropped.stress_sum.max_pa == Approx(250.0 * found[weight].stress_sum.max_pa).epsilon(1e-4));
        CHECK(dropped.max_displacement_mm == Approx(250.0 * found[weight].max_displacement_mm).epsilon(1e-4));
    }
    settings.structure.remove_supports = false;
    settings.fixtures.erase(settings.fixtures.begin());
    const std::vector<StrengthCase> right_alone = cases(settings);
    CHECK(found[2].name == "gravity, without left");
    CHECK(found[2].stress_sum.max_pa == right_alone[0].stress_sum.max_pa);
    // A cantilever bends 48 times as far as a beam that is held at both ends: q L^4 / 8 against q L^4 / 384.
    CHECK(found[2].max_displacement_mm > 30.0 * found[0].max_displacement_mm);
    CHECK(found[2].max_displacement_mm < 60.0 * found[0].max_displacement_mm);
}

TEST_CASE("strength check: worst cases are those of the carved object, in balance, and need the model",
          "[strength][loads]") {
    const TriangleMesh model = make_box(Vec3::Zero(), Vec3(40, 40, 40), {8, 8, 8});
    // Walls of 3 mm; the front has a wide window, which leaves narrow posts.
    const std::vector<double> lines = {0, 3, 4, 36, 37, 40};
    const TriangleMesh carved =
        block_mesh({{lines, lines, lines}, {{{3, 1, 32, 1, 3}, {3, 1, 32, 1, 3}, {3, 1, 32, 1, 3}}}},
                   [](const std::array<int, 3>& at) {
                       const auto inner = [](int i) { return i >= 1 && i <= 3; };
                       const bool hollow = inner(at[0]) && inner(at[1]) && inner(at[2]);
                       const bool window = at[1] == 0 && inner(at[0]) && inner(at[2]);
                       return hollow || window ? Block::empty() : Block::solid();
                   });
    Settings settings;
    settings.structure.profile = LoadProfile::kGravity;
    settings.structure.weak_regions = 3;
    settings.structure.handling_force_n = 15.0;
    const SurfaceLoads loads = loads_of_source(model, {}, settings, 60);
    CHECK(loads.profile.worst.regions == 3);
    const StrengthReport report = check_strength(carved, loads, settings_at(60)).report;
    REQUIRE(report.cases.size() == 4);
    for (std::size_t c = 1; c < 4; ++c) {
        CAPTURE(report.cases[c].name);
        CHECK(report.cases[c].name.starts_with("worst case at ("));
        // 30 N act, and next to nothing is left for what holds.
        CHECK(report.cases[c].applied_n.norm() < 0.3);
        CHECK(report.cases[c].stress_sum.max_pa > 100.0 * report.cases[0].stress_sum.max_pa);
    }
    CHECK_THROWS_WITH(check_strength(carved, loads_of_carved(carved, settings, 60), settings_at(60)),
                      Catch::Contains("structure.weak_regions"));
}

}  // namespace
}  // namespace fretwork
