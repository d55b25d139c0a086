#include "core/strength/strength.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/shell/voxelize.h"
#include "core/strength/strength_faults.h"
#include "core/strength/voxel_stress.h"
#include "strength_fixtures.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

/// A force on the nodes where `takes` says so, spread by the area of the end that they stand for.
void push_end(const VoxelModel& model, std::int32_t x, const Vec3& force_n, VoxelCase& load_case) {
    load_case.push_n.resize(3 * model.nodes.size());
    std::ranges::fill(load_case.push_n, 0.0);
    std::size_t faces = 0;
    for (const VoxelCoord& v : model.voxels) faces += v[0] == x - 1 ? 1 : 0;
    for (std::size_t v = 0; v < model.voxels.size(); ++v)
        for (const NodeIndex n : model.corners[v])
            if (model.voxels[v][0] == x - 1 && model.nodes[n][0] == x)
                for (int k = 0; k < 3; ++k)
                    load_case.push_n[3 * std::size_t{n} + static_cast<std::size_t>(k)] +=
                        0.25 * force_n[k] / static_cast<double>(faces);
}

TEST_CASE("strength: a bar stands under its own weight as the sum says", "[strength]") {
    // Without Poisson's ratio the state is one of tension alone, linear in height, which the element holds exactly.
    const double h = 0.5, gravity = 9.81;
    const VoxelModel model = full_block({4, 3, 40}, h);
    const Material material = rubbery(100.0, 0.0);
    const std::vector<VoxelCase> cases = {
        {"stands", -Vec3::UnitZ(), {}, held_where(model, [](const VoxelCoord& v) { return v[2] == 0; })}};
    for (const SolveBy solver : {SolveBy::kFactor, SolveBy::kMultigrid}) {
        StrengthSettings settings = settings_with(material);
        settings.solver = solver;
        settings.tolerance = 1e-10;
        const StrengthReport report = analyze_strength(model, cases, settings);
        const double weight_per_mm3 = 1000.0 * 1e-9 * gravity, length = 39 * h;
        for (std::size_t v = 0; v < model.voxels.size(); ++v) {
            const double above = (40 - model.voxels[v][2] - 0.5) * h;
            const double expected = model.voxels[v][2] == 0 ? 0.0 : -weight_per_mm3 * above;
            Stress state = Stress::Zero();
            state[2] = expected;
            REQUIRE((report.cases[0].stress_mpa[v] - state).norm() < 1e-8 * weight_per_mm3 * length);
        }
        CHECK(report.cases[0].max_displacement_mm ==
              Approx(weight_per_mm3 * length * length / (2 * 100.0)).epsilon(1e-8));
        CHECK(report.weight_n == Approx(weight_per_mm3 * 2 * 1.5 * 20));
        CHECK(report.cases[0].applied_n[2] == Approx(-report.weight_n));
        CHECK((report.cases[0].applied_n + report.cases[0].reaction_n).norm() < 1e-8 * report.weight_n);
        // The weakest voxel lies right above the support.
        CHECK(report.weakest.at(0).at_mm[2] == Approx(1.5 * h));
    }
}

TEST_CASE("strength: a cantilever bends as Timoshenko says", "[strength]") {
    const VoxelModel model = full_block({41, 5, 5});
    std::vector<VoxelCase> cases = {
        {"tip", Vec3::Zero(), {}, held_where(model, [](const VoxelCoord& v) { return v[0] == 0; })}};
    push_end(model, 41, Vec3(0, 0, -1), cases[0]);
    const StrengthReport report = analyze_strength(model, cases, settings_with(rubbery(2000.0, 0.35)));
    const double E = 2000.0, I = 625.0 / 12.0, G = E / 2.7, kappa = 10 * 1.35 / (12 + 11 * 0.35);
    const double timoshenko_mm = 64000.0 / (3 * E * I) + 40.0 / (kappa * G * 25.0);
    CHECK(report.cases[0].max_displacement_mm < timoshenko_mm);
    CHECK(report.cases[0].max_displacement_mm > 0.98 * timoshenko_mm);
    // What CalculiX finds for the same 40 cubes with C3D8I.
    CHECK(report.cases[0].max_displacement_mm == Approx(0.2042).epsilon(5e-3));
    // Bending in the middle of a voxel of the outermost layer, 20.5 mm from the tip: M z / I.
    for (std::size_t v = 0; v < model.voxels.size(); ++v)
        if (model.voxels[v] == VoxelCoord{20, 2, 4})
            CHECK(report.cases[0].stress_mpa[v][0] == Approx(20.5 * 2.0 / I).epsilon(0.02));
}

TEST_CASE("strength: a clamped plate sags as Mindlin says", "[strength]") {
    const VoxelModel model = full_block({62, 62, 3});
    const Material material = rubbery(2000.0, 0.3);
    const std::vector<VoxelCase> cases = {{"sags", -Vec3::UnitZ(), {}, held_where(model, [](const VoxelCoord& v) {
                                               return v[0] == 0 || v[1] == 0 || v[0] == 61 || v[1] == 61;
                                           })}};
    const StrengthReport report = analyze_strength(model, cases, settings_with(material));
    const double q = 1000.0 * 1e-9 * 9.81 * 3.0, D = 2000.0 * 27.0 / (12 * (1 - 0.09));
    // Timoshenko and Woinowsky-Krieger: 0.00126 for a thin plate; shear adds 5 % at a thickness of a twentieth.
    const double thin_mm = 0.00126 * q * std::pow(60.0, 4) / D;
    CHECK(report.cases[0].max_displacement_mm > 1.02 * thin_mm);
    CHECK(report.cases[0].max_displacement_mm < 1.08 * thin_mm);
}

TEST_CASE("strength: what pushes twice as hard does twice as much, and supports push back", "[strength]") {
    const VoxelModel model = carved_ball(36);
    const std::vector<std::uint8_t> held = held_where(model, [](const VoxelCoord& v) { return v[2] < 4; });
    const std::vector<VoxelCase> cases = {
        {"x", Vec3::UnitX(), {}, held}, {"z", Vec3::UnitZ(), {}, held}, {"both", Vec3(2, 0, -3), {}, held}};
    for (const SolveBy solver : {SolveBy::kFactor, SolveBy::kMultigrid}) {
        StrengthSettings settings = settings_with(rubbery(2000.0, 0.35));
        settings.solver = solver;
        settings.tolerance = 1e-10;
        const StrengthReport report = analyze_strength(model, cases, settings);
        CHECK(report.by_factor == (solver == SolveBy::kFactor));
        double most = 0.0, most_wrong = 0.0;
        for (std::size_t n = 0; n < model.nodes.size(); ++n) {
            const Vec3 sum = 2.0 * report.cases[0].displacement_mm[n] - 3.0 * report.cases[1].displacement_mm[n];
            most = std::max(most, sum.norm());
            most_wrong = std::max(most_wrong, (sum - report.cases[2].displacement_mm[n]).norm());
        }
        CHECK(most > 0.0);
        CHECK(most_wrong < 1e-8 * most);
        for (const StrengthCase& load_case : report.cases) {
            CHECK(load_case.applied_n.norm() > 0.9 * report.weight_n);
            CHECK((load_case.applied_n + load_case.reaction_n).norm() < 1e-7 * report.weight_n);
        }
    }
}

TEST_CASE("strength: the factor of safety is the least of within and between layers", "[strength]") {
    Material material = rubbery(2000.0, 0.35);  // 30 MPa within, 20 MPa between
    const auto factor = [&](std::array<double, 6> s, const Vec3& layers = Vec3::UnitZ()) {
        return safety_factor_of(Eigen::Map<const Stress>(s.data()), layers, material);
    };
    CHECK(factor({10, 0, 0, 0, 0, 0}) == Approx(3.0));                   // pulled along a layer
    CHECK(factor({0, 0, 10, 0, 0, 0}) == Approx(2.0));                   // pulled across layers
    CHECK(factor({0, 0, -10, 0, 0, 0}) == Approx(3.0));                  // pressed across layers: they cannot part
    CHECK(factor({0, 0, 0, 10, 0, 0}) == Approx(3.0 / std::sqrt(3.0)));  // sheared within a layer
    CHECK(factor({0, 0, 0, 0, 10, 0}) == Approx(2.0 / std::sqrt(3.0)));  // sheared along layers
    CHECK(factor({0, 0, 0, 0, 0, 10}) == Approx(2.0 / std::sqrt(3.0)));
    CHECK(factor({10, 0, 0, 0, 0, 0}, Vec3(5, 0, 0)) == Approx(2.0));  // layers stacked along x
    CHECK(factor({0, 0, 0, 0, 0, 0}) == kMostFactor);
    CHECK(von_mises(Stress{5, 5, 5, 0, 0, 0}) == 0.0);
}

TEST_CASE("strength: statistics are those of the sorted list", "[strength]") {
    std::vector<float> values;
    for (int i = 200; i >= 1; --i) values.push_back(static_cast<float>(i));
    const StressStatistics s = statistics_of(values);
    CHECK(s.average_pa == Approx(100.5));
    CHECK(s.median_pa == 100.0);
    CHECK(s.p99_pa == 198.0);
    CHECK(s.max_pa == 200.0);
    CHECK(statistics_of({7.0F}).p99_pa == 7.0);
}

TEST_CASE("strength: weak places are told once, the weakest first", "[strength]") {
    // Two necks in a bar that is pulled: one of 2 x 2 and one of 4 x 4 voxels.
    const VoxelModel model = voxels_where({80, 6, 6}, 1.0, [](const VoxelCoord& c) {
        if (c[0] >= 20 && c[0] < 24) return c[1] >= 2 && c[1] < 4 && c[2] >= 2 && c[2] < 4;
        if (c[0] >= 55 && c[0] < 59) return c[1] >= 1 && c[1] < 5 && c[2] >= 1 && c[2] < 5;
        return true;
    });
    std::vector<VoxelCase> cases = {
        {"pulled", Vec3::Zero(), {}, held_where(model, [](const VoxelCoord& v) { return v[0] == 0; })}};
    push_end(model, 80, Vec3(60, 0, 0), cases[0]);
    const StrengthReport report = analyze_strength(model, cases, settings_with(rubbery(2000.0, 0.35)));
    REQUIRE(report.weakest.size() >= 2);
    CHECK(report.weakest[0].at_mm[0] == Approx(22.0).margin(2.5));
    // 60 N on 4 mm^2 is half of the 30 MPa, and somewhat more at the notches.
    CHECK(report.weakest[0].factor < 2.0);
    CHECK(report.weakest[0].factor > 1.0);
    CHECK(report.least_factor == Approx(report.weakest[0].factor));
    std::size_t second = 1;
    while (second < report.weakest.size() && report.weakest[second].at_mm[0] < 40.0) ++second;
    REQUIRE(second < report.weakest.size());
    CHECK(report.weakest[second].at_mm[0] == Approx(57.0).margin(2.5));
    for (std::size_t i = 0; i < report.weakest.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            CHECK(report.weakest[i].factor >= report.weakest[j].factor);
            CHECK((report.weakest[i].at_mm - report.weakest[j].at_mm).norm() > 3.0);
        }
    // The same in words.
    CHECK_FALSE(report.holds());
    const std::vector<std::string> faults = strength_faults(report);
    REQUIRE(faults.size() == 1);
    CHECK(faults[0].find("is too weak under \"pulled\" at (2") == 0);
    StrengthSettings less = settings_with(rubbery(2000.0, 0.35));
    less.safety_factor = 1.0;
    CHECK(strength_faults(analyze_strength(model, cases, less)).empty());
}

TEST_CASE("strength: pieces that nothing holds stand on their lowest tenth", "[strength]") {
    const VoxelModel model = voxels_where({5, 2, 30}, 1.0, [](const VoxelCoord& c) { return c[0] != 2; });
    const std::vector<VoxelCase> cases = self_weight_cases(model, 0.1);
    REQUIRE(cases.size() == 3);
    for (std::size_t v = 0; v < model.voxels.size(); ++v) CHECK((cases[0].held[v] != 0) == (model.voxels[v][2] < 3));
    CHECK(cases[2].acceleration_g == Vec3(0, 0, -1));
    CHECK_THROWS_AS(self_weight_cases(model, 0.0), InvalidSetting);
}

TEST_CASE("strength: loads of the surface reach the voxels with all their force", "[strength]") {
    const TriangleMesh ball = make_icosphere(10.0, 4);
    const SurfaceVoxels shell = voxelize(ball, {.resolution = 40});
    // The upper half of a hollow ball is carved away to a few ribs: pushes on holes go to the nearest of them.
    const VoxelModel model = voxels_where({40, 40, 40}, 0.5, [](const VoxelCoord& c) {
        const Vec3 p(c[0] - 19.5, c[1] - 19.5, c[2] - 19.5);
        return p.norm() < 20.0 && p.norm() > 16.0 && (c[2] < 20 || std::abs(p[0]) < 3.0 || std::abs(p[1]) < 3.0);
    });
    VoxelModel placed = model;
    placed.grid.origin_mm = Vec3::Constant(-10.0);
    ForceProfile profile;
    LoadCase& push = profile.cases.emplace_back();
    push.name = "push";
    PatchLoad& patch = push.loads.emplace_back();
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        if (shell.points_mm[v][2] > 5.0) patch.voxels.push_back(v);
        if (shell.points_mm[v][2] < -7.0) push.fixed.push_back(v);
    }
    patch.force_n = Vec3(1, 2, -30);
    const std::vector<VoxelCase> cases = cases_of(profile, shell, placed);
    REQUIRE(cases.size() == 1);
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < cases[0].push_n.size(); ++i) sum[static_cast<int>(i % 3)] += cases[0].push_n[i];
    CHECK((sum - patch.force_n).norm() < 1e-9);
    for (std::size_t v = 0; v < placed.voxels.size(); ++v) {
        const double z = placed.grid.center_mm(placed.voxels[v])[2];
        if (cases[0].held[v] != 0) CHECK(z < -7.0 + 2.0);
        if (z < -9.0) CHECK(cases[0].held[v] != 0);
    }
    // A pressure on the whole ball is in balance; on its upper cap it presses downwards with the cap's shadow.
    patch.force_n.setZero();
    patch.pressure_mpa = 0.1;
    Vec3 pressed = Vec3::Zero();
    const std::vector<VoxelCase> under_pressure = cases_of(profile, shell, placed);
    for (std::size_t i = 0; i < under_pressure[0].push_n.size(); ++i)
        pressed[static_cast<int>(i % 3)] += under_pressure[0].push_n[i];
    CHECK(pressed[2] == Approx(-0.1 * 3.14159 * 75.0).epsilon(0.1));
}

TEST_CASE("strength: loads of the surface keep their lines of action", "[strength]") {
    const SurfaceVoxels shell = voxelize(make_box(Vec3::Zero(), Vec3(10, 10, 10)), {.resolution = 7});
    const VoxelModel model = full_block({10, 10, 10});
    ForceProfile profile;
    PatchLoad& patch = profile.cases.emplace_back().loads.emplace_back();
    patch.force_n = Vec3(1, 2, -30);
    Vec3 turning = Vec3::Zero();
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (shell.points_mm[v][0] > 9.0) patch.voxels.push_back(v);
    REQUIRE(patch.voxels.size() > 20);
    for (const VoxelIndex v : patch.voxels)
        turning += shell.points_mm[v].cross(patch.force_n) / static_cast<double>(patch.voxels.size());
    const VoxelCase found = cases_of(profile, shell, model).front();
    Vec3 turned = Vec3::Zero();
    for (NodeIndex n = 0; n < model.nodes.size(); ++n)
        turned += model.node_mm(n).cross(Vec3(found.push_n[3 * n], found.push_n[3 * n + 1], found.push_n[3 * n + 2]));
    CHECK((turned - turning).norm() < 1e-6 * turning.norm());
}

TEST_CASE("strength: cases with supports of their own come out as if alone", "[strength]") {
    const VoxelModel model = full_block({12, 6, 5});
    std::vector<VoxelCase> cases = self_weight_cases(model);
    cases[1].held = held_where(model, [](const VoxelCoord& c) { return c[0] == 0; });
    const StrengthSettings settings = settings_with(rubbery(2000.0, 0.35));
    const StrengthReport together = analyze_strength(model, cases, settings);
    for (std::size_t c = 0; c < cases.size(); ++c) {
        CAPTURE(c);
        const StrengthReport alone = analyze_strength(model, {cases[c]}, settings);
        CHECK(alone.cases[0].max_displacement_mm > 0.0);
        CHECK(together.cases[c].max_displacement_mm == Approx(alone.cases[0].max_displacement_mm).epsilon(1e-9));
        CHECK(together.cases[c].stress_sum.max_pa == Approx(alone.cases[0].stress_sum.max_pa).epsilon(1e-6));
    }
    CHECK(together.cases[1].max_displacement_mm > 2.0 * together.cases[0].max_displacement_mm);
}

TEST_CASE("strength: the same report on any number of threads", "[strength]") {
    const TriangleMesh torus = make_torus(20, 4, 48, 24);
    std::vector<StrengthReport> reports;
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        const VoxelModel model = make_voxel_model(torus, 0.8);
        StrengthSettings settings = settings_with(rubbery(2000.0, 0.35));
        settings.solver = SolveBy::kMultigrid;
        reports.push_back(analyze_strength(model, self_weight_cases(model), settings));
    }
    for (const StrengthReport& report : {reports[1], reports[2]}) {
        CHECK(report.worst_stress_sum_pa == reports[0].worst_stress_sum_pa);
        CHECK(report.least_factor == reports[0].least_factor);
        for (std::size_t c = 0; c < 3; ++c) {
            CHECK(report.cases[c].displacement_mm == reports[0].cases[c].displacement_mm);
            CHECK(report.cases[c].reaction_n == reports[0].cases[c].reaction_n);
            CHECK(report.cases[c].stress_sum.average_pa == reports[0].cases[c].stress_sum.average_pa);
        }
    }
}

TEST_CASE("strength: rejects what cannot be analysed, and progress rises to 1", "[strength]") {
    const VoxelModel model = full_block({3, 3, 6});
    const std::vector<VoxelCase> cases = self_weight_cases(model);
    const StrengthSettings good = settings_with(rubbery(2000.0, 0.35));
    CHECK_THROWS_AS(analyze_strength(model, {}, good), InvalidSetting);
    StrengthSettings bad = good;
    bad.tolerance = 0.0;
    CHECK_THROWS_AS(analyze_strength(model, cases, bad), InvalidSetting);
    bad = good;
    bad.layers.setZero();
    CHECK_THROWS_AS(analyze_strength(model, cases, bad), InvalidSetting);
    bad = good;
    bad.material.strength_z_mpa = 0.0;
    CHECK_THROWS_AS(analyze_strength(model, cases, bad), InvalidSetting);
    bad = good;
    bad.max_memory_bytes = 1000;
    CHECK_THROWS_AS(analyze_strength(model, cases, bad), MemoryLimit);
    for (const SolveBy solver : {SolveBy::kFactor, SolveBy::kMultigrid}) {
        double last = 0.0;
        bool rises = true;
        StrengthSettings settings = good;
        settings.solver = solver;
        analyze_strength(model, cases, settings, RunControl([&](std::string_view, double fraction) {
                             rises = rises && fraction >= last;
                             last = fraction;
                         }));
        CHECK(rises);
        CHECK(last == 1.0);
    }
}

}  // namespace
}  // namespace fretwork
