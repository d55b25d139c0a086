#include "core/pipeline/resolve_settings.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <regex>

#include "core/base/error.h"
#include "core/mesh/mesh_report.h"
#include "core/pipeline/memory_use.h"
#include "core/pipeline/prepare_surface.h"
#include "core/pipeline/settings_schema.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

constexpr SurfaceFacts kSurface{100.0, false};
constexpr ExemplarFacts kExemplar{128, 4.0, {}};

Settings with(std::initializer_list<const char*> assignments) {
    SpecDocument document;
    for (const char* text : assignments) document.assignments.push_back(parse_assignment(text, "test"));
    return settings_from(document);
}

ResolvedSettings resolve(std::initializer_list<const char*> assignments) {
    return resolve_settings(with(assignments), kSurface, kExemplar);
}

TEST_CASE("resolve: defaults follow from the size of the model", "[pipeline]") {
    const ResolvedSettings r = resolve({});
    CHECK(r.voxelize.resolution == 256);
    CHECK(r.voxel_mm == 100.0 / 256);
    CHECK(r.solidify.thickness_mm == 2.0);  // 2 % of 100 mm, over 2.5 voxels of 0.39 mm and three nozzles
    CHECK(r.exemplar_width_mm == Approx(50.0));
    CHECK(r.synthesis.pixels_per_voxel == Approx(1.0));
    CHECK(r.enlarge.min_feature_mm == Approx(0.8));
    CHECK(r.enlarge.min_hole_mm == Approx(0.8));
    CHECK(r.reinforce.pattern_radius_voxels == Approx(4.0));  // half a stroke of 8 pixels at one pixel per voxel
    CHECK(r.pyramid_levels == 8);
    CHECK(r.solidify.side == WallSide::kInward);
    CHECK(resolve_settings({}, {100.0, true}, kExemplar).solidify.side == WallSide::kCentred);
}

TEST_CASE("resolve: resolution is a matter of quality, not of design", "[pipeline]") {
    const ResolvedSettings coarse = resolve({"shell.resolution=128"}), fine = resolve({"shell.resolution=512"});
    CHECK(coarse.exemplar_width_mm == fine.exemplar_width_mm);
    CHECK(coarse.synthesis.pixels_per_voxel == Approx(4.0 * fine.synthesis.pixels_per_voxel));
    CHECK(resolve({"shell.voxel_mm=0.5"}).voxelize.resolution == 200);
    CHECK(resolve({"synthesis.preset=draft", "shell.voxel_mm=0.5"}).voxelize.resolution == 200);
    CHECK(resolve({"synthesis.scale=1.5"}).exemplar_width_mm == Approx(75.0));
    CHECK(resolve({"exemplar.width_mm=20"}).synthesis.pixels_per_voxel == Approx(128 / 20.0 * 100 / 256));
}

TEST_CASE("resolve: a draft keeps the design of its full run and coarsens the grid as far as it takes", "[pipeline]") {
    // 14,000 faces of surface at most: a sphere of 100 mm has 206,000 at 256, 51,000 at half and 13,000 at a quarter.
    const SurfaceFacts sphere{100.0, false, 31400.0};
    const auto resolve_sphere = [&](std::initializer_list<const char*> assignments) {
        return resolve_settings(with(assignments), sphere, kExemplar);
    };
    const ResolvedSettings full = resolve_sphere({}), draft = resolve_sphere({"synthesis.preset=draft"});
    CHECK(full.voxelize.halvings == 0);
    CHECK(draft.voxelize.resolution == full.voxelize.resolution);
    CHECK(draft.voxelize.halvings == 2);
    CHECK(draft.voxel_mm == 4.0 * full.voxel_mm);
    CHECK(draft.synthesis.skipped_levels == 2);
    CHECK(draft.synthesis.pixels_per_voxel == 4.0 * full.synthesis.pixels_per_voxel);
    CHECK(draft.pyramid_levels == full.pyramid_levels - 2);
    CHECK(draft.exemplar_width_mm == full.exemplar_width_mm);
    CHECK(draft.synthesis.candidates == full.synthesis.candidates);
    CHECK(draft.synthesis.coarse_passes == full.synthesis.coarse_passes);
    // What the coarse grid cannot hold grows to what it can; what the full run refuses is refused.
    CHECK(draft.solidify.thickness_mm == Approx(std::max(full.solidify.thickness_mm, 2.0 * draft.voxel_mm)));
    CHECK(draft.reinforce.thickness_mm == draft.solidify.thickness_mm);
    CHECK(draft.enlarge.min_feature_mm == Approx(0.8));  // not what two coarse voxels would make of it
    CHECK(draft.enlarge.draft);
    CHECK(draft.reinforce.pattern_radius_voxels == 1.5);
    CHECK_NOTHROW(resolve_sphere({"synthesis.preset=draft", "shell.thickness_mm=1"}));
    CHECK_THROWS_AS(resolve_sphere({"synthesis.preset=draft", "shell.thickness_mm=0.5"}), ConstraintsNotMet);
    // Any resolution ends at about as many voxels; a coarse one is left alone; the key wins.
    CHECK(resolve_sphere({"synthesis.preset=draft", "shell.resolution=1024"}).voxelize.halvings == 4);
    CHECK(resolve_sphere({"synthesis.preset=draft", "shell.resolution=64"}).voxelize.halvings == 0);
    CHECK(resolve_sphere({"synthesis.preset=draft", "shell.halvings=1"}).voxelize.halvings == 1);
    CHECK(resolve_sphere({"shell.halvings=3"}).voxelize.halvings == 3);
}

struct Contradiction {
    std::vector<const char*> asked;
    const char* first;  ///< both are named
    const char* second;
    const char* remedy;  ///< the key whose value in the message makes it work
};

TEST_CASE("resolve: how far walls reach inside follows from their side", "[pipeline]") {
    Settings settings;
    settings.shell.thickness_mm = 2.0;
    const auto inner_mm = [&](bool open) {
        return resolve_settings(settings, {100.0, open}, kExemplar).reinforce.inner_wall_mm;
    };
    CHECK(inner_mm(false) == 2.0);
    CHECK(inner_mm(true) == 1.0);
    settings.shell.side = WallSide::kOutward;
    CHECK(inner_mm(false) == 0.0);
    settings.shell.side = WallSide::kInward;
    settings.structure.steps.rules = ReinforceRules::kPaper;
    CHECK(inner_mm(false) == 0.0);
}

TEST_CASE("resolve: a contradiction names both values and one that works", "[pipeline]") {
    const auto c = GENERATE(values<Contradiction>({
        {{"shell.thickness_mm=0.5"}, "shell.thickness_mm = 0.5", "0.390625", "shell.resolution"},
        {{"shell.thickness_mm=60"}, "shell.thickness_mm = 60", "100 mm", nullptr},
        {{"fabrication.min_hole_mm=0.3"}, "fabrication.min_hole_mm = 0.3", "fabrication.nozzle_mm = 0.4", nullptr},
        {{"fabrication.min_feature_mm=0.3"}, "min_feature_mm = 0.3", "nozzle_mm = 0.4", nullptr},
        {{"fabrication.min_feature_mm=0.5"}, "min_feature_mm = 0.5", "0.390625", "shell.resolution"},
        {{"fabrication.min_hole_mm=60"}, "min_hole_mm = 60", "100 mm", nullptr},
        {{"exemplar.width_mm=120"}, "exemplar.width_mm = 120", "100 mm", "synthesis.scale"},
        {{"exemplar.width_mm=2"}, "exemplar.width_mm = 2", "0.390625", "shell.resolution"},
        {{"structure.pattern_radius_mm=0.4"}, "pattern_radius_mm = 0.4", "0.390625", "shell.resolution"},
        {{"shell.resolution=100", "shell.voxel_mm=2"}, "shell.resolution = 100", "shell.voxel_mm = 2", nullptr},
        {{"shell.voxel_mm=0.001"}, "shell.voxel_mm = 0.001", "100 mm", nullptr},
    }));
    SpecDocument document;
    for (const char* text : c.asked) document.assignments.push_back(parse_assignment(text, "test"));
    std::string message;
    try {
        resolve_settings(settings_from(document), kSurface, kExemplar);
    } catch (const ConstraintsNotMet& error) {
        message = error.what();
    }
    CAPTURE(c.asked[0], message);
    CHECK(message.find(c.first) != std::string::npos);
    CHECK(message.find(c.second) != std::string::npos);
    if (!c.remedy) return;
    // "use ... shell.resolution = 400": following the advice must work.
    std::smatch found;
    const std::regex advice(c.remedy == std::string("shell.resolution") ? "shell\\.resolution = ([0-9]+)$"
                                                                        : "scale of at most ([0-9.]+)$");
    REQUIRE(std::regex_search(message, found, advice));
    document.assignments.push_back(parse_assignment(std::string(c.remedy) + "=" + found[1].str(), "test"));
    CHECK_NOTHROW(resolve_settings(settings_from(document), kSurface, kExemplar));
}

TEST_CASE("prepare: the named axis ends up as z, unmirrored", "[pipeline]") {
    // Sides of 10, 20 and 30 mm with a corner at the origin: the octant the box lands in tells a turn from a mirror,
    // which the volume cannot, because repair faces every mesh outward.
    const TriangleMesh box = testing::make_box(Vec3(0, 0, 0), Vec3(10, 20, 30));
    const auto check = [&](UpAxis up, const Vec3& min_mm, const Vec3& max_mm) {
        InputOptions input;
        input.up = up;
        const MeshReport report = report_mesh(prepare_surface(box, input).mesh);
        CHECK(report.min_mm == min_mm);
        CHECK(report.max_mm == max_mm);
    };
    check(UpAxis::kX, Vec3(-30, 0, 0), Vec3(0, 20, 10));
    check(UpAxis::kY, Vec3(0, -30, 0), Vec3(10, 0, 20));
    check(UpAxis::kZ, Vec3(0, 0, 0), Vec3(10, 20, 30));
    check(UpAxis::kMinusX, Vec3(0, 0, -10), Vec3(30, 20, 0));
    check(UpAxis::kMinusY, Vec3(0, 0, -20), Vec3(10, 30, 0));
    check(UpAxis::kMinusZ, Vec3(0, -20, -30), Vec3(10, 0, 0));
}

TEST_CASE("resolve: a model in other units is told, not carved", "[pipeline]") {
    const TriangleMesh tiny = testing::make_box(Vec3(0, 0, 0), Vec3(1, 0.5, 0.25));
    CHECK_THROWS_WITH(input_scale(tiny, {}), Catch::Contains("--size-mm") && Catch::Contains("1 mm"));
    CHECK(input_scale(tiny, {.scale = 1.0, .size_mm = 80.0}) == Approx(80.0));
    CHECK(input_scale(tiny, {.scale = 25.4, .size_mm = {}}) == Approx(25.4));
    CHECK_THROWS_AS(input_scale(tiny, {.scale = 2.0, .size_mm = 80.0}), ConstraintsNotMet);
    CHECK_THROWS_AS(input_scale(tiny, {.scale = 1e5, .size_mm = {}}), ConstraintsNotMet);
    CHECK_THROWS_AS(input_scale(TriangleMesh{}, {}), InvalidInput);
}

TEST_CASE("resolve: materials by name or by number", "[pipeline]") {
    const ResolvedSettings r = resolve({"structure.material=PETG", "structure.youngs_modulus_mpa=1234"});
    CHECK(r.material.youngs_modulus_mpa == 1234.0);
    CHECK(r.material.density_kg_m3 == material_by_name("PETG").density_kg_m3);
    CHECK_THROWS_AS(resolve({"structure.material=cheese"}), InvalidSetting);
}

TEST_CASE("memory: the estimate grows with resolution, and a limit names what fits", "[pipeline]") {
    const TriangleMesh box = testing::make_box(Vec3(0, 0, 0), Vec3(100, 100, 100));
    const ResolvedSettings coarse = resolve({"shell.resolution=64"}), fine = resolve({"shell.resolution=512"});
    CHECK(estimated_peak_bytes(box, coarse) < estimated_peak_bytes(box, fine));
    CHECK_NOTHROW(check_memory(box, fine, 0));
    CHECK_NOTHROW(check_memory(box, fine, estimated_peak_bytes(box, fine)));
    const std::uint64_t limit = estimated_peak_bytes(box, coarse) * 2;
    std::string message;
    try {
        check_memory(box, fine, limit);
    } catch (const MemoryLimit& error) {
        message = error.what();
    }
    std::smatch found;
    REQUIRE(std::regex_search(message, found, std::regex("use shell\\.resolution = ([0-9]+)$")));
    ResolvedSettings advised = fine;
    advised.voxelize.resolution = std::stoi(found[1]);
    advised.voxel_mm = advised.longest_side_mm / advised.voxelize.resolution;
    CHECK(advised.voxelize.resolution >= 64);
    CHECK_NOTHROW(check_memory(box, advised, limit));
}

TEST_CASE("memory: the estimate is above what runs have used, and not far above", "[pipeline]") {
    // Peaks of a bunny of 100 mm, the least and the most of plain and colourful patterns; a box with as much surface.
    struct Measured {
        const char* resolution;
        double least_mb, most_mb;
    };
    const double side = std::sqrt(23900.0 / 6.0);
    const TriangleMesh box = testing::make_box(Vec3(0, 0, 0), Vec3(side, side, side));
    for (const Measured& run :
         {Measured{"shell.resolution=64", 238, 260}, Measured{"shell.resolution=128", 303, 368},
          Measured{"shell.resolution=256", 1014, 1340}, Measured{"shell.resolution=512", 3926, 3926}}) {
        CAPTURE(run.resolution);
        const ResolvedSettings settings = resolve({run.resolution});
        const double estimate = 1e-6 * static_cast<double>(estimated_peak_bytes(box, settings));
        CHECK(estimate >= run.most_mb);
        CHECK(estimate <= 1.4 * run.least_mb);
    }
}

}  // namespace
}  // namespace fretwork
