#include "core/strength/strength.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/strength/voxel_solver.h"
#include "core/strength/voxel_stress.h"

namespace fretwork {
namespace {

constexpr double kStandardGravity = 9.81;  // m/s^2, as for the beams
constexpr std::size_t kSideBySide = 3;     // right-hand sides that are solved together

void check(const std::vector<VoxelCase>& cases, const StrengthSettings& settings) {
    if (cases.empty()) throw InvalidSetting("strength: found no load case, expected at least one");
    const auto in_range = [](double value, double low, double high, const char* name) {
        if (!(value >= low && value <= high))
            throw InvalidSetting(fmt::format("strength: {} = {:g}; expected {:g} to {:g}", name, value, low, high));
    };
    in_range(settings.tolerance, 1e-12, 0.1, "tolerance");
    in_range(settings.safety_factor, 1e-3, 1e3, "safety factor");
    if (!(settings.layers.norm() > 0.0) || !settings.layers.allFinite())
        throw InvalidSetting("strength: the direction of the layers is zero; expected a vector");
    if (!(settings.material.strength_xy_mpa > 0.0 && settings.material.strength_z_mpa > 0.0))
        throw InvalidSetting("strength: the material has no strength; expected above 0 MPa");
}

std::vector<std::uint8_t> fixed_nodes(const VoxelModel& model, const std::vector<std::uint8_t>& held) {
    std::vector<std::uint8_t> fixed(model.nodes.size(), 0);
    for (std::size_t v = 0; v < held.size(); ++v)
        if (held[v] != 0)
            for (const NodeIndex n : model.corners[v]) fixed[n] = 1;
    return fixed;
}

NodeValues<double> forces(const VoxelModel& model, const VoxelCase& load_case, const Material& material,
                          double volume_mm3) {
    NodeValues<double> force_n;
    if (load_case.push_n.empty()) {
        force_n.resize(3 * model.nodes.size());
        std::ranges::fill(force_n, 0.0);
    } else {
        force_n = load_case.push_n;
    }
    const double kg = volume_mm3 * material.density_kg_m3 * 1e-9;
    const Vec3 share_n = 0.125 * kg * kStandardGravity * load_case.acceleration_g;
    for (const auto& corners : model.corners)
        for (const NodeIndex n : corners)
            for (std::size_t axis = 0; axis < 3; ++axis)
                force_n[3 * std::size_t{n} + axis] += share_n[static_cast<int>(axis)];
    return force_n;
}

Vec3 total(const NodeValues<double>& per_node) {
    return sum_in_fixed_order(per_node.size() / 3, 8192, Vec3(Vec3::Zero()), [&](std::size_t n) {
        return Vec3(per_node[3 * n], per_node[3 * n + 1], per_node[3 * n + 2]);
    });
}

/// Cases that share their supports, in the order in which they came.
std::vector<std::vector<std::size_t>> groups_by_supports(const std::vector<VoxelCase>& cases) {
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t c = 0; c < cases.size(); ++c) {
        const auto same =
            std::ranges::find_if(groups, [&](const auto& group) { return cases[group[0]].held == cases[c].held; });
        if (same == groups.end())
            groups.push_back({c});
        else
            same->push_back(c);
    }
    return groups;
}

class Analysis {
  public:
    Analysis(const VoxelModel& model, const std::vector<VoxelCase>& cases, const StrengthSettings& settings)
        : model_(model),
          cases_(cases),
          settings_(settings),
          cube_(cube_element(model.grid.voxel_mm, settings.material)),
          judge_(model, cube_.center_stress, settings) {
        report_.voxel_mm = model.grid.voxel_mm;
        report_.voxels = model.voxels.size();
        report_.nodes = model.nodes.size();
        report_.pieces = model.pieces;
        report_.joining_voxels = model.joining_voxels;
        report_.volume_mm3 = cube_.volume_mm3 * static_cast<double>(model.voxels.size());
        report_.weight_n = report_.volume_mm3 * settings.material.density_kg_m3 * 1e-9 * kStandardGravity;
        report_.safety_factor = settings.safety_factor;
        report_.cases.resize(cases.size());
    }

    StrengthReport run(const RunControl& run) {
        std::size_t done = 0;
        for (const std::vector<std::size_t>& group : groups_by_supports(cases_)) {
            const auto share = [&](std::size_t count) {
                return static_cast<double>(count) / static_cast<double>(cases_.size());
            };
            run_group(group, run.slice(share(done), share(done + group.size())));
            done += group.size();
        }
        judge_.conclude(report_);
        run.checkpoint("strength", 1.0);
        return std::move(report_);
    }

  private:
    void run_group(std::span<const std::size_t> group, const RunControl& run) {
        const std::uint64_t besides = memory_for(model_, cases_.size());
        if (besides >= settings_.max_memory_bytes)
            throw MemoryLimit(
                fmt::format("strength: {} voxels take {:.1f} GB, allowed are {:.1f} GB; larger voxels "
                            "need less",
                            model_.voxels.size(), static_cast<double>(besides) * 1e-9,
                            static_cast<double>(settings_.max_memory_bytes) * 1e-9));
        const VoxelSolver solver(model_, cube_, fixed_nodes(model_, cases_[group[0]].held),
                                 {settings_.solver, settings_.tolerance, settings_.factor_below_voxels,
                                  static_cast<std::size_t>(settings_.max_memory_bytes - besides)},
                                 run);
        report_.by_factor = solver.by() == SolveBy::kFactor;
        report_.factor_bytes = std::max(report_.factor_bytes, solver.factor_bytes());
        run.checkpoint("strength", 0.3);
        for (std::size_t first = 0; first < group.size(); first += kSideBySide) {
            const auto some = group.subspan(first, std::min(kSideBySide, group.size() - first));
            const double from = static_cast<double>(first) / static_cast<double>(group.size());
            const double to = static_cast<double>(first + some.size()) / static_cast<double>(group.size());
            solve_some(solver, some, run.slice(0.3 + 0.7 * from, 0.3 + 0.7 * to));
        }
    }

    void solve_some(const VoxelSolver& solver, std::span<const std::size_t> some, const RunControl& run) {
        std::vector<NodeValues<double>> force_n;
        for (const std::size_t c : some)
            force_n.push_back(forces(model_, cases_[c], settings_.material, cube_.volume_mm3));
        const std::vector<VoxelSolution> solutions = solver.solve(force_n, run.slice(0.0, 0.9));
        for (std::size_t k = 0; k < some.size(); ++k) {
            run.throw_if_stopped();
            StrengthCase& result = report_.cases[some[k]];
            result.name = cases_[some[k]].name;
            result.iterations = solutions[k].iterations;
            result.applied_n = total(force_n[k]);
            result.reaction_n = solver.reaction_n(solutions[k].displacement_mm, force_n[k]);
            judge_.add_case(solutions[k].displacement_mm, static_cast<std::uint32_t>(some[k]), result);
        }
    }

    const VoxelModel& model_;
    const std::vector<VoxelCase>& cases_;
    const StrengthSettings& settings_;
    CubeElement cube_;
    VoxelJudge judge_;
    StrengthReport report_;
};

}  // namespace

std::uint64_t memory_for(const VoxelModel& model, std::size_t cases) {
    // Counted from the arrays that live at once, and compared with what runs have taken (tests/bench/strength_bench).
    const std::uint64_t side_by_side = std::min(cases, kSideBySide);
    const std::uint64_t per_node = 12 + 8 + 24 + side_by_side * (24 + 5 * 24 + 12) + 36;
    const std::uint64_t per_voxel = 12 + 32 + 4 + 1 + 20 + 400;  // 400: cells, pattern and matrix of the coarse level
    return per_node * model.nodes.size() + per_voxel * model.voxels.size();
}

StrengthReport analyze_strength(const VoxelModel& model, const std::vector<VoxelCase>& cases,
                                const StrengthSettings& settings, const RunControl& run) {
    check(cases, settings);
    return Analysis(model, cases, settings).run(run);
}

}  // namespace fretwork
