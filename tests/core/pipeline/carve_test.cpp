#include "core/pipeline/carve.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <thread>

#include "core/base/error.h"
#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/pipeline/settings_schema.h"
#include "core/reinforce/pattern_pieces.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

CarveInput input_for(const TriangleMesh& mesh, const char* pattern) {
    return {mesh, "test model", make_builtin(pattern), 24.0, pattern};
}

Settings quick(int resolution = 40) {
    Settings settings;
    apply_preset(settings, Preset::kDraft);
    settings.shell.resolution = resolution;
    settings.structure.steps.samples = 120;
    settings.structure.steps.max_iterations = 3;
    return settings;
}

TriangleMesh small_vase() {
    return testing::make_vase(50.0, 40, 24);
}

TEST_CASE("carve: a draft of a fine spec keeps one piece and a valid mesh on a fraction of the voxels", "[pipeline]") {
    SpecDocument document;
    for (const char* text : {"synthesis.preset=draft", "shell.resolution=400", "shell.thickness_mm=0.8",
                             "fabrication.min_hole_mm=0.5", "structure.samples=120"})
        document.assignments.push_back(parse_assignment(text, "test"));
    const CarveResult result = carve(input_for(small_vase(), "cells"), settings_from(document));
    const RunReport& r = result.report;
    CHECK(r.shell.surface_voxels < 60000);
    CHECK(r.shell.resolution < 200);
    CHECK(r.pattern.components_after == 1);
    CHECK(r.pattern.solid_fraction < 0.97);
    CHECK(r.mesh.report.closed_manifold());
    CHECK(r.mesh.report.self_intersections == 0);
    // The report's settings make the same run again.
    SpecDocument again{r.settings, {}};
    const CarveResult repeated = carve(input_for(small_vase(), "cells"), settings_from(again));
    CHECK(repeated.solid == result.solid);
    CHECK(repeated.carved.mesh.positions_mm == result.carved.mesh.positions_mm);
}

TEST_CASE("carve: the record agrees with the result", "[pipeline]") {
    const CarveResult result = carve(input_for(small_vase(), "cells"), quick());
    const RunReport& r = result.report;
    CHECK(r.shell.surface_voxels == result.shell.size());
    CHECK(r.pattern.solid_voxels ==
          static_cast<std::size_t>(std::count(result.solid.begin(), result.solid.end(), SolidState::kSolid)));
    CHECK(r.pattern.solid_fraction > 0.05);
    CHECK(r.pattern.solid_fraction < 0.97);
    CHECK(r.pattern.components_after == 1);
    CHECK(pattern_pieces(result.shell, result.solid).one_each());
    CHECK_FALSE(r.iterations.empty());
    CHECK_FALSE(r.structure.stopped_by.empty());
    CHECK(r.mesh.report.triangles == result.carved.mesh.triangles.size());
    CHECK(r.mesh.report.closed_manifold());
    CHECK(r.mesh.report.self_intersections == 0);
    CHECK(r.mesh.report.volume_mm3 > 0.0);
    CHECK(result.carved.triangle_colors.size() == result.carved.mesh.triangles.size());
    CHECK(result.voxel_colors.size() == result.shell.size());
    double seconds = 0.0;
    for (const StageSeconds& stage : r.seconds) seconds += stage.seconds;
    CHECK(r.seconds.size() == 8);
    CHECK(seconds <= r.seconds_total);
    CHECK(r.peak_memory_bytes > 0);
    // Every number that was left open is told.
    for (const SettingAssignment& setting : r.settings)
        if (setting.key == "shell.thickness_mm") CHECK(std::get<double>(setting.value) == r.shell.thickness_mm);
}

TEST_CASE("carve: printability is judged, but not of a draft", "[pipeline]") {
    Settings full = quick();
    CHECK_FALSE(carve(input_for(small_vase(), "cells"), full).report.print);
    full.synthesis.preset = Preset::kDefault;
    full.fabrication.layer_height_mm = 0.5;
    const CarveResult result = carve(input_for(small_vase(), "cells"), full);
    REQUIRE(result.report.print);
    const PrintabilityReport& print = result.report.print->report;
    CHECK(print.layers == 100);
    CHECK(print.material_mm3 == Approx(result.report.mesh.report.volume_mm3));
    CHECK(print.loose_parts == 0);
    // Two rings through each other are two pieces, and none of them is loose.
    const CarveResult rings = carve(input_for(testing::make_linked_tori(20.0, 5.0), "cells"), full);
    REQUIRE(rings.report.shell.components == 2);
    REQUIRE(rings.report.print);
    CHECK(rings.report.print->report.loose_parts == 0);
}

TEST_CASE("carve: threads do not show in the result", "[pipeline][determinism]") {
    const CarveInput input = input_for(small_vase(), "waves");
    const CarveResult one = carve(input, quick(), {1, 0});
    for (const int threads : {2, 4}) {
        const CarveResult many = carve(input, quick(), {threads, 0});
        CHECK(many.solid == one.solid);
        CHECK(many.reinforced == one.reinforced);
        CHECK(many.carved.mesh.triangles == one.carved.mesh.triangles);
        CHECK(many.carved.mesh.positions_mm == one.carved.mesh.positions_mm);
        CHECK(many.carved.triangle_colors == one.carved.triangle_colors);
    }
}

TEST_CASE("carve: progress rises from 0 to 1 over all stages", "[pipeline]") {
    double last = -1.0;
    std::vector<std::string> stages;
    bool fell = false;
    const RunControl run([&](std::string_view stage, double fraction) {
        if (fraction < last) fell = true;
        last = fraction;
        if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
    });
    carve(input_for(small_vase(), "dots"), quick(32), {}, run);
    CHECK_FALSE(fell);
    CHECK(last == 1.0);
    CHECK(stages.size() >= 8);
}

// How long a stop takes is measured by the benchmark `cancel_latency`; here, that it is honoured wherever it comes.
TEST_CASE("carve: stops at once when it is asked to, whenever that is", "[pipeline][cancel]") {
    const double share = GENERATE(0.0, 0.03, 0.1, 0.25, 0.4, 0.55, 0.7, 0.85, 0.97);
    std::stop_source source;
    std::size_t reports_after = 0;
    const auto listen = [&](std::string_view, double fraction) {
        if (source.stop_requested())
            ++reports_after;
        else if (fraction >= share)
            source.request_stop();
    };
    CHECK_THROWS_AS(carve(input_for(small_vase(), "cells"), quick(48), {}, RunControl(listen, source.get_token())),
                    Cancelled);
    CHECK(reports_after == 0);
}

// From another thread, within a stage and between two reports.
TEST_CASE("carve: a stop from another thread ends the run without a result", "[pipeline][cancel]") {
    const int delay_ms = GENERATE(1, 40, 160, 420);
    std::stop_source source;
    double last = 0.0;
    std::jthread timer([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
        source.request_stop();
    });
    const RunControl run([&](std::string_view, double fraction) { last = fraction; }, source.get_token());
    CHECK_THROWS_AS(carve(input_for(small_vase(), "cells"), quick(160), {}, run), Cancelled);
    CHECK(last < 1.0);
}

TEST_CASE("carve: what is kept stays solid, what is not named for carving too", "[pipeline]") {
    const TriangleMesh vase = small_vase();
    Settings settings = quick();
    const HalfSpaceRegion foot{Vec3(0, 0, 15), Vec3::UnitZ()};
    SECTION("keep") {
        settings.keep.push_back({"foot", foot});
    }
    SECTION("carve") {
        settings.carve.push_back({"body", HalfSpaceRegion{Vec3(0, 0, 15), -Vec3::UnitZ()}});
    }
    const CarveResult result = carve(input_for(vase, "dots"), settings);
    CHECK(result.report.pattern.kept_voxels > 0);
    std::size_t empty_above = 0;
    for (std::size_t v = 0; v < result.shell.size(); ++v) {
        if (result.shell.points_mm[v][2] < 15.0)
            REQUIRE(result.solid[v] == SolidState::kSolid);
        else if (result.solid[v] == SolidState::kEmpty)
            ++empty_above;
    }
    CHECK(empty_above > 100);
}

TEST_CASE("carve: another seed, another arrangement", "[pipeline]") {
    Settings settings = quick(32);
    const CarveInput input = input_for(small_vase(), "zebra");
    const CarveResult first = carve(input, settings);
    settings.synthesis.search.seed = 2;
    CHECK(carve(input, settings).solid != first.solid);
}

TEST_CASE("carve: colours as asked", "[pipeline]") {
    Settings settings = quick(32);
    const CarveInput input = input_for(small_vase(), "cells");
    settings.output.colour = OutputColor::kNone;
    CHECK(carve(input, settings).carved.triangle_colors.empty());
    settings.output.colour = OutputColor::kSolid;
    const std::vector<Rgb8> one = carve(input, settings).carved.triangle_colors;
    REQUIRE_FALSE(one.empty());
    CHECK(std::count(one.begin(), one.end(), one.front()) == static_cast<std::ptrdiff_t>(one.size()));
}

TEST_CASE("carve: what cannot be carved is refused", "[pipeline]") {
    const TriangleMesh vase = small_vase();
    TriangleMesh dangling = vase;
    dangling.triangles.back()[0] = 1'000'000;
    CHECK_THROWS_AS(carve(input_for({}, "cells"), quick()), InvalidInput);
    CHECK_THROWS_AS(carve(input_for(dangling, "cells"), quick()), InvalidInput);
    CHECK_THROWS_AS(carve(input_for(vase, "cells"), quick(), {0, 1'000'000}), MemoryLimit);

    Settings thin = quick();
    thin.shell.thickness_mm = 0.5;
    CHECK_THROWS_AS(carve(input_for(vase, "cells"), thin), ConstraintsNotMet);
    CHECK_THROWS_AS(check_carve(input_for(vase, "cells"), thin), ConstraintsNotMet);
    Settings nowhere = quick();
    nowhere.keep.push_back({"moon", SphereRegion{Vec3(0, 0, 1e4), 1.0}});
    CHECK_THROWS_WITH(carve(input_for(vase, "cells"), nowhere), Catch::Contains("moon"));
    CHECK_THROWS_WITH(check_carve(input_for(vase, "cells"), nowhere), Catch::Contains("moon"));
    Settings unloaded = quick();
    unloaded.structure.profile = LoadProfile::kOwn;
    CHECK_THROWS_AS(check_carve(input_for(vase, "cells"), unloaded), ConstraintsNotMet);
}

TEST_CASE("carve: a check tells the numbers of the run", "[pipeline]") {
    const CarveInput input = input_for(small_vase(), "cells");
    const RunReport checked = check_carve(input, quick());
    const RunReport carved = carve(input, quick()).report;
    CHECK(checked.shell.voxel_mm == carved.shell.voxel_mm);
    CHECK(checked.shell.thickness_mm == carved.shell.thickness_mm);
    CHECK(checked.shell.components == carved.shell.components);
    CHECK(checked.input.mesh.triangles == carved.input.mesh.triangles);
    CHECK(checked.settings.size() == carved.settings.size());
    // A draft has looked at how much stays solid.
    CHECK(checked.pattern.solid_fraction == Approx(carved.pattern.solid_fraction).margin(0.15));
}

TEST_CASE("carve: a check foresees what the draft of a run finds", "[pipeline]") {
    const CarveInput input = input_for(small_vase(), "cells");
    const auto told = [&](const Settings& settings, const std::string& what) {
        const std::vector<std::string> warnings = check_carve(input, settings).warnings;
        return std::ranges::any_of(warnings, [&](const std::string& w) { return w.find(what) != w.npos; });
    };
    CHECK_FALSE(told(quick(), "allowable stress"));
    Settings weak = quick();
    weak.structure.strength_mpa = 0.01;
    CHECK(told(weak, "a draft: stress of"));
}

TEST_CASE("carve: a check of a tall model looks at fewer layers, and foresees where a run would find too many",
          "[pipeline]") {
    Settings settings = quick();
    settings.input.size_mm = 1000.0;
    const auto thicker = [&](double layer_mm) {
        settings.fabrication.layer_height_mm = layer_mm;
        for (const std::string& warning : check_carve(input_for(small_vase(), "cells"), settings).warnings)
            if (warning.find("looked at in layers of") != warning.npos) return warning;
        return std::string();
    };
    CHECK(thicker(2.0).empty());
    CHECK_THAT(thicker(0.2), Catch::Contains("layers of 1 mm") && Catch::Contains("layers of 0.2 mm"));
    settings.input.size_mm = 2000.0;
    CHECK_THROWS_WITH(thicker(0.01), Catch::Contains("more than 100000 layers of 0.01"));
    settings.synthesis.preset = Preset::kDefault;  // a run that looks at its layers
    CHECK_THROWS_WITH(carve(input_for(small_vase(), "cells"), settings), Catch::Contains("more than 100000 layers"));
}

TEST_CASE("carve: more triangles than were wanted are owned up to", "[pipeline]") {
    const auto told = [](int wanted) {
        Settings settings = quick();
        settings.fabrication.target_triangles = wanted;
        const RunReport report = carve(input_for(small_vase(), "cells"), settings).report;
        const bool warned = std::ranges::any_of(
            report.warnings, [](const std::string& w) { return w.find("fabrication.target_triangles") != w.npos; });
        CHECK(warned == (wanted > 0 && report.mesh.report.triangles > static_cast<std::size_t>(wanted)));
        return warned;
    };
    CHECK(told(10));
    CHECK_FALSE(told(1000000));
    CHECK_FALSE(told(0));
}

}  // namespace
}  // namespace fretwork
