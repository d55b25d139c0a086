#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/pipeline/carve.h"
#include "core/pipeline/strength_rounds.h"
#include "core/reinforce/pattern_pieces.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

CarveInput vase() {
    return {testing::make_vase(50.0, 40, 24), "vase", make_builtin("cells"), 24.0, "cells"};
}

/// Reinforced in one turn without any budget of its own, so that something is left for the rounds.
Settings pushed_with(double force_n, int rounds) {
    Settings settings;
    settings.shell.resolution = 64;
    settings.structure.steps.samples = 100;
    settings.structure.steps.max_iterations = 1;
    settings.structure.handling_force_n = force_n;
    settings.structure.verify_rounds = rounds;
    return settings;
}

double budget_of(const Settings& settings, const CarveResult& result) {
    return settings.structure.steps.material_budget * static_cast<double>(result.shell.size());
}

std::size_t added_in(const StrengthRecord& strength) {
    std::size_t added = 0;
    for (const StrengthRound& round : strength.rounds) added += round.voxels_added;
    return added;
}

TEST_CASE("strength rounds: what is too weak is strengthened until it holds", "[pipeline][strength]") {
    Settings settings = pushed_with(60.0, 8);
    constexpr double kAsked = 1.9;
    settings.structure.steps.safety_factor = kAsked;
    const CarveResult result = carve(vase(), settings);
    REQUIRE(result.report.strength);
    const StrengthRecord& strength = *result.report.strength;
    REQUIRE(strength.rounds.size() > 1);
    CHECK(strength.rounds.front().least_factor < kAsked);
    CHECK(strength.rounds.front().weak_voxels > 0);
    CHECK(strength.rounds.back().least_factor >= kAsked);
    CHECK(strength.rounds.back().weak_voxels == 0);
    CHECK(strength.check.report.least_factor == strength.rounds.back().least_factor);
    CHECK(strength.stopped_by == "holds");
    CHECK(strength.faults.empty());
    CHECK(static_cast<double>(added_in(strength)) <= budget_of(settings, result));

    // Another analysis of what came out says the same.
    const StrengthCheckSettings check = strength_check_settings(settings, 0);
    const SurfaceLoads loads = loads_of_source(vase().mesh, {}, settings, check.resolution);
    CHECK(check_strength(result.carved.mesh, loads, check).report.least_factor ==
          Approx(strength.rounds.back().least_factor).epsilon(1e-4));
    // And the other promises stand.
    CHECK(result.report.pattern.components_after == 1);
    CHECK(pattern_pieces(result.shell, result.solid).one_each());
    CHECK(result.report.mesh.report.closed_manifold());
    CHECK(result.report.mesh.report.self_intersections == 0);
    CHECK(result.report.pattern.reinforced_voxels ==
          static_cast<std::size_t>(std::ranges::count(result.reinforced, std::uint8_t{1})));
    const float most_mpa = *std::ranges::max_element(result.stress_mpa);
    CHECK(most_mpa == Approx(1e-6 * strength.check.report.stress_sum.max_pa).epsilon(1e-4));
}

TEST_CASE("strength rounds: what holds already stays as it is", "[pipeline][strength]") {
    const CarveResult plain = carve(vase(), pushed_with(1.0, 0));
    const CarveResult checked = carve(vase(), pushed_with(1.0, 8));
    CHECK_FALSE(plain.report.strength);
    REQUIRE(checked.report.strength);
    CHECK(checked.report.strength->rounds.size() == 1);
    CHECK(checked.report.strength->stopped_by == "holds");
    CHECK(checked.carved.mesh.positions_mm == plain.carved.mesh.positions_mm);
    CHECK(checked.carved.mesh.triangles == plain.carved.mesh.triangles);
    CHECK(checked.solid == plain.solid);
    CHECK(checked.reinforced == plain.reinforced);
}

TEST_CASE("strength rounds: what cannot hold is left as strong as it became, and says so", "[pipeline][strength]") {
    const CarveResult result = carve(vase(), pushed_with(2000.0, 20));
    REQUIRE(result.report.strength);
    const StrengthRecord& strength = *result.report.strength;
    CHECK(strength.stopped_by != "holds");
    CHECK(strength.stopped_by != "rounds");
    double best = 0.0;
    for (const StrengthRound& round : strength.rounds) best = std::max(best, round.least_factor);
    CHECK(best < 2.0);
    CHECK(best >= strength.rounds.front().least_factor);
    CHECK(strength.check.report.least_factor == best);
    // What came out is the strongest of them.
    const StrengthCheckSettings check = strength_check_settings(pushed_with(2000.0, 20), 0);
    const SurfaceLoads loads = loads_of_source(vase().mesh, {}, pushed_with(2000.0, 20), check.resolution);
    CHECK(check_strength(result.carved.mesh, loads, check).report.least_factor == Approx(best).epsilon(1e-4));
    REQUIRE(strength.faults.size() == 1);
    CHECK(std::ranges::any_of(result.report.warnings, [&](const std::string& warning) {
        return warning.starts_with(strength.faults.front());
    }));
    // The vase is not filled up for it.
    CHECK(result.report.pattern.solid_fraction < 0.97);
}

TEST_CASE("strength rounds: no more of them and no more voxels than allowed", "[pipeline][strength]") {
    const CarveResult one = carve(vase(), pushed_with(100.0, 1));
    REQUIRE(one.report.strength);
    CHECK(one.report.strength->rounds.size() == 2);
    CHECK(one.report.strength->stopped_by == "rounds");
    Settings sparing = pushed_with(100.0, 8);
    sparing.structure.steps.material_budget = 0.002;
    const CarveResult few = carve(vase(), sparing);
    REQUIRE(few.report.strength);
    CHECK(few.report.strength->stopped_by == "budget");
    const std::size_t added = added_in(*few.report.strength);
    CHECK(static_cast<double>(added) <= budget_of(sparing, few));
    CHECK(static_cast<double>(added) > budget_of(sparing, few) - 1.0);
}

TEST_CASE("strength rounds: two rounds that gain nothing are enough, and the strongest object stays",
          "[pipeline][strength]") {
    Settings settings = pushed_with(300.0, 0), thinner = settings;
    settings.shell.thickness_mm = 2.4;
    thinner.shell.thickness_mm = 1.6;
    const CarveResult strong = carve(vase(), settings), weak = carve(vase(), thinner);
    const auto object = [](const CarveResult& result, std::vector<std::uint8_t> forced) {
        MadeObject made;
        made.forced = std::move(forced);
        made.enlarged.solid = result.solid;
        made.carved.mesh = result.carved.mesh;
        return made;
    };
    const StrengthCheckSettings check = strength_check_settings(settings, 0);
    const SurfaceLoads loads = loads_of_source(vase().mesh, {}, settings, check.resolution);
    int made = 0;
    const StrengthRounds rounds =
        strengthen(object(strong, std::vector<std::uint8_t>(strong.shell.size(), 0)), strong.shell,
                   link_two_rings(strong.shell), loads, {8, 1.0, 6.0, check},
                   [&](std::vector<std::uint8_t> forced, const std::vector<VoxelIndex>& added, const RunControl&) {
                       CHECK_FALSE(added.empty());
                       return object(++made == 1 ? weak : strong, std::move(forced));
                   },
                   {});
    CHECK(made == 2);
    CHECK(rounds.record.stopped_by == "no gain");
    REQUIRE(rounds.record.rounds.size() == 3);
    CHECK(rounds.record.rounds[1].least_factor < 0.98 * rounds.record.rounds[0].least_factor);
    CHECK(rounds.object.carved.mesh.positions_mm == strong.carved.mesh.positions_mm);
    CHECK(rounds.record.check.report.least_factor == rounds.record.rounds[0].least_factor);
    CHECK(std::ranges::count(rounds.object.forced, std::uint8_t{1}) == 0);
}

TEST_CASE("strength rounds: threads do not show in the result", "[pipeline][strength][determinism]") {
    const Settings settings = pushed_with(60.0, 1);
    const CarveResult one = carve(vase(), settings, {.threads = 1});
    const CarveResult two = carve(vase(), settings, {.threads = 2});
    CHECK(one.carved.mesh.positions_mm == two.carved.mesh.positions_mm);
    CHECK(one.carved.mesh.triangles == two.carved.mesh.triangles);
    CHECK(one.stress_mpa == two.stress_mpa);
    REQUIRE(one.report.strength->rounds.size() == two.report.strength->rounds.size());
    for (std::size_t i = 0; i < one.report.strength->rounds.size(); ++i)
        CHECK(one.report.strength->rounds[i].least_factor == two.report.strength->rounds[i].least_factor);
}

TEST_CASE("strength rounds: a draft goes without and says so", "[pipeline][strength]") {
    Settings draft = pushed_with(10.0, 8);
    draft.synthesis.preset = Preset::kDraft;
    const CarveResult result = carve(vase(), draft);
    CHECK_FALSE(result.report.strength);
    CHECK(std::ranges::any_of(result.report.warnings, [](const std::string& warning) {
        return warning.find("verify_rounds") != std::string::npos;
    }));
}

}  // namespace
}  // namespace fretwork
