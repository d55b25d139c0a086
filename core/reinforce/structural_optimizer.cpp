#include "core/reinforce/structural_optimizer.h"

#include <algorithm>
#include <limits>
#include <numbers>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/graph/firm_links.h"
#include "core/reinforce/connect_pieces.h"
#include "core/reinforce/drop_specks.h"
#include "core/reinforce/paint_bridges.h"
#include "core/reinforce/reinforcement_turn.h"
#include "core/reinforce/repair_contacts.h"

namespace fretwork {
namespace {

/// Rounds of bridges in one turn, each after a solution of the equilibrium. Fewer would make bridges that are blended
/// into the pattern sooner, but every turn also costs an abstract graph, a model and a resynthesis.
constexpr int kRoundsPerTurn = 4;

/// A turn has gained when the highest score or the 99th percentile is this much below the best so far.
constexpr double kGain = 0.95;
constexpr int kTurnsWithoutGain = 2;

template <class T>
void check_range(const char* name, T value, T least, T most) {
    if (!(value >= least && value <= most))
        throw InvalidSetting(std::string("reinforce: ") + name + " is " + std::to_string(value) + "; expected " +
                             std::to_string(least) + " to " + std::to_string(most));
}

void check_settings(const ReinforceSettings& s) {
    constexpr double kMost = 1e6;
    if (!(s.thickness_mm > 0.0 && s.thickness_mm <= kMost))
        throw InvalidSetting("reinforce: thickness_mm is " + std::to_string(s.thickness_mm) + "; expected above 0");
    check_range("pattern_radius_voxels", s.pattern_radius_voxels, 1.5, kMost);
    check_range("samples", s.samples, 10, 20000);
    check_range("safety_factor", s.safety_factor, 1.0, kMost);
    check_range("geodesic_factor", s.geodesic_factor, 0.0, kMost);
    check_range("soft_factor", s.soft_factor, 1e-8, 1.0);
    check_range("stress_ratio", s.stress_ratio, 1.0, kMost);
    check_range("material_budget", s.material_budget, 0.0, 1.0);
    check_range("batch", s.batch, 1, 10000);
    check_range("max_iterations", s.max_iterations, 1, 100000);
}

void check_profile(const SurfaceVoxels& shell, const ForceProfile& profile) {
    if (profile.cases.empty())
        throw InvalidInput("reinforce: the force profile has no load case; expected one or more");
    const auto check = [&](const std::vector<VoxelIndex>& voxels, const LoadCase& load_case) {
        for (const VoxelIndex v : voxels)
            if (v >= shell.size())
                throw InvalidInput("reinforce: load case \"" + load_case.name + "\" names voxel " + std::to_string(v) +
                                   " of a shell of " + std::to_string(shell.size()));
    };
    for (const LoadCase& load_case : profile.cases) {
        check(load_case.fixed, load_case);
        for (const PatchLoad& patch : load_case.loads) check(patch.voxels, load_case);
    }
}

bool is_self_weight_alone(const ForceProfile& profile) {
    return profile.worst.regions == 0 &&
           std::ranges::all_of(profile.cases, [](const LoadCase& load_case) { return load_case.loads.empty(); });
}

}  // namespace

/// Whether stress bridges are still worth their material.
struct StressProgress {
    bool budget_spent = false;  ///< a bridge did not fit any more
    double best_max_pa = std::numeric_limits<double>::infinity();
    double best_p99_pa = std::numeric_limits<double>::infinity();
    int turns_without_gain = 0;

    void take(const ReinforceRecord& record) {
        const bool gain = record.max_score_pa < kGain * best_max_pa || record.p99_score_pa < kGain * best_p99_pa;
        turns_without_gain = gain ? 0 : turns_without_gain + 1;
        best_max_pa = std::min(best_max_pa, record.max_score_pa);
        best_p99_pa = std::min(best_p99_pa, record.p99_score_pa);
    }
};

struct StructuralOptimizer::Impl {
    const SurfaceVoxels& shell;
    const ForceProfile& profile;
    Material material;
    ReinforceSettings settings;
    Adjacency firm;
    ShellComponents shell_components;
    BridgePainter painter;
    std::vector<VoxelIndex> facing;    ///< walls that have grown together bear loads together
    std::vector<std::uint8_t> keep;    ///< solid by the user's wish or forced by an earlier turn
    std::vector<std::uint8_t> forced;  ///< by an earlier turn

    // What a turn changes only when it ends well.
    int iteration = 0;
    double frozen_median_pa = -1.0;  ///< negative until the first connected pattern was solved
    std::size_t voxels_left = 0;     ///< of the material budget
    StressProgress progress;
    std::vector<double> sample_radius;

    Impl(const SurfaceVoxels& shell_in, const ForceProfile& profile_in, const Material& material_in,
         const ReinforceSettings& settings_in, std::vector<std::uint8_t> keep_in)
        : shell(shell_in),
          profile(profile_in),
          material(material_in),
          settings(settings_in),
          firm(firm_links(shell.adjacency)),
          shell_components(connected_components(shell.adjacency)),
          painter(shell, firm, settings.pattern_radius_voxels),
          facing(facing_voxels(shell_in, settings_in.inner_wall_mm)),
          keep(std::move(keep_in)),
          forced(shell.size(), 0),
          voxels_left(static_cast<std::size_t>(settings.material_budget * static_cast<double>(shell.size()))) {
        keep.resize(shell.size(), 0);
    }

    [[nodiscard]] double allowable_pa() const { return 1e6 * material.strength_z_mpa / settings.safety_factor; }
    [[nodiscard]] double limit_pa(double median_pa) const;
    [[nodiscard]] SolidStates with_forced(const SolidStates& solid) const;
    DroppedSpecks drop(SolidStates& state) const;
    [[nodiscard]] bool every_component_has_solid(const SolidStates& state) const;
    struct Outcome;
    void connect_and_seed(SolidStates& state, Outcome& outcome, const RunControl& run);
    void reinforce_as_printed(SolidStates& state, Outcome& outcome, const RunControl& run);
    void reinforce(SolidStates& state, Outcome& outcome, const RunControl& run);
    void take_stock(SolidStates& state, Outcome& outcome, const RunControl& run);
    void commit(const SolidStates& before, const Outcome& outcome, ReinforceStep& step);
};

/// What one turn has found out so far.
struct StructuralOptimizer::Impl::Outcome {
    ReinforceRecord record;
    std::vector<VoxelIndex> covered;  ///< voxels to be forced, with repeats
    std::size_t pieces = 0;           ///< firm ones, after connecting
    bool asks_for_resynthesis = false;
    double frozen_median_pa = -1.0;
    std::size_t voxels_left = 0;
    StressProgress progress;
    std::vector<double> sample_radius;
    std::string stopped_by = "limits met";
    ScoredPaths scored;
};

/// The allowable stress; where self-weight is the only load, which never comes near it, a multiple of what half of
/// the edges carry.
double StructuralOptimizer::Impl::limit_pa(double median_pa) const {
    const double relative = settings.stress_ratio * median_pa;
    return is_self_weight_alone(profile) ? std::min(allowable_pa(), relative) : allowable_pa();
}

SolidStates StructuralOptimizer::Impl::with_forced(const SolidStates& solid) const {
    SolidStates state = solid;
    for (std::size_t v = 0; v < state.size(); ++v)
        if (forced[v] != 0) state[v] = SolidState::kSolid;
    return state;
}

DroppedSpecks StructuralOptimizer::Impl::drop(SolidStates& state) const {
    const double radius = settings.pattern_radius_voxels;
    SpeckRules rules;
    rules.least_voxels = static_cast<std::size_t>(std::numbers::pi * radius * radius);
    return drop_specks(firm, shell_components, keep, rules, state);
}

bool StructuralOptimizer::Impl::every_component_has_solid(const SolidStates& state) const {
    std::vector<std::uint8_t> has_solid(shell_components.count(), 0);
    for (std::size_t v = 0; v < state.size(); ++v)
        if (state[v] == SolidState::kSolid) has_solid[shell_components.of[v]] = 1;
    return std::ranges::count(has_solid, std::uint8_t{0}) == 0;
}

void StructuralOptimizer::Impl::connect_and_seed(SolidStates& state, Outcome& outcome, const RunControl& run) {
    const std::vector<VoxelIndex> seeds =
        seed_empty_components(shell_components, painter, 2.0 * settings.pattern_radius_voxels, state);
    const DilatedPart part = settings.rules == ReinforceRules::kPaper ? DilatedPart::kWholePath : DilatedPart::kGap;
    const ConnectedPieces connected = connect_pieces(shell, firm, shell_components, painter, part, state, run);
    outcome.covered.insert(outcome.covered.end(), seeds.begin(), seeds.end());
    outcome.covered.insert(outcome.covered.end(), connected.covered.begin(), connected.covered.end());
    outcome.pieces = connected.pieces;
    outcome.record.bridges_connect += connected.bridges;
    outcome.asks_for_resynthesis = outcome.asks_for_resynthesis || !seeds.empty() || connected.bridges > 0;
}

namespace {

void merge_record(const ReinforceRecord& turn, ReinforceRecord& record) {
    record.bridges_connect += turn.bridges_connect;
    record.bridges_stress += turn.bridges_stress;
    record.bridges_geodesic += turn.bridges_geodesic;
    record.max_score_pa = turn.max_score_pa;
    record.p99_score_pa = turn.p99_score_pa;
    record.median_score_pa = turn.median_score_pa;
    record.average_score_pa = turn.average_score_pa;
    record.max_geodesic = turn.max_geodesic;
}

}  // namespace

void StructuralOptimizer::Impl::reinforce_as_printed(SolidStates& state, Outcome& outcome, const RunControl& run) {
    const ReinforceContext context{shell, firm, shell_components, profile, material, settings, facing};
    ReinforcementTurn turn(context, painter, state, outcome.record.iteration, outcome.sample_radius, run);
    turn.take_stock(run);
    outcome.scored = turn.scored_paths();
    turn.connect_by_score(run);
    turn.stress_as_printed(allowable_pa(), run);
    std::size_t no_budget = std::numeric_limits<std::size_t>::max();
    if (settings.geodesic_factor > 0.0) turn.geodesics(no_budget, run);
    turn.paint_selected();
    merge_record(turn.record(), outcome.record);
    outcome.covered.insert(outcome.covered.end(), turn.covered().begin(), turn.covered().end());
    outcome.asks_for_resynthesis = turn.bridges() > 0;
    if (turn.out_of_candidates()) outcome.stopped_by = "no candidate";
}

void StructuralOptimizer::Impl::reinforce(SolidStates& state, Outcome& outcome, const RunControl& run) {
    const ReinforceContext context{shell, firm, shell_components, profile, material, settings, facing};
    ReinforcementTurn turn(context, painter, state, outcome.record.iteration, outcome.sample_radius, run);
    turn.take_stock(run);
    outcome.scored = turn.scored_paths();
    if (outcome.frozen_median_pa < 0.0) outcome.frozen_median_pa = turn.record().median_score_pa;
    outcome.progress.take(turn.record());
    const double limit = limit_pa(outcome.frozen_median_pa);
    const bool met = turn.record().max_score_pa <= limit;
    const bool hopeless = outcome.progress.turns_without_gain >= kTurnsWithoutGain;
    const bool spent = outcome.progress.budget_spent;
    if (!met && !hopeless && !spent) turn.stress_within_budget(limit, kRoundsPerTurn, outcome.voxels_left, run);
    // As printed: in every turn, on what the bridges against stress have left.
    if (!turn.out_of_budget() && !spent && settings.geodesic_factor > 0.0) turn.geodesics(outcome.voxels_left, run);
    outcome.progress.budget_spent = spent || turn.out_of_budget();
    merge_record(turn.record(), outcome.record);
    outcome.covered.insert(outcome.covered.end(), turn.covered().begin(), turn.covered().end());
    outcome.asks_for_resynthesis = outcome.asks_for_resynthesis || turn.bridges() > 0;
    if (outcome.progress.budget_spent)
        outcome.stopped_by = "budget";
    else if (!met)
        outcome.stopped_by = hopeless ? "no gain" : "no candidate";
}

/// The last turn adds nothing against stress, but says what the result bears.
void StructuralOptimizer::Impl::take_stock(SolidStates& state, Outcome& outcome, const RunControl& run) {
    const ReinforceContext context{shell, firm, shell_components, profile, material, settings, facing};
    ReinforcementTurn turn(context, painter, state, outcome.record.iteration, outcome.sample_radius, run);
    turn.take_stock(run);
    outcome.scored = turn.scored_paths();
    merge_record(turn.record(), outcome.record);
}

void StructuralOptimizer::Impl::commit(const SolidStates& before, const Outcome& outcome, ReinforceStep& step) {
    step.record = outcome.record;
    for (const VoxelIndex v : outcome.covered) {
        if (forced[v] != 0) continue;
        forced[v] = 1;
        keep[v] = 1;
        step.forced_solid.push_back(v);
        step.record.voxels_added += before[v] == SolidState::kEmpty ? 1u : 0u;
    }
    std::ranges::sort(step.forced_solid);
    step.record.connected = outcome.pieces == shell_components.count();
    iteration = outcome.record.iteration;
    frozen_median_pa = outcome.frozen_median_pa;
    voxels_left = outcome.voxels_left;
    progress = outcome.progress;
    sample_radius = outcome.sample_radius;
}

StructuralOptimizer::StructuralOptimizer(const SurfaceVoxels& shell, const ForceProfile& profile,
                                         const Material& material, const ReinforceSettings& settings,
                                         std::vector<std::uint8_t> keep) {
    check_settings(settings);
    if (shell.size() == 0) throw InvalidInput("reinforce: the shell has no voxel");
    if (!keep.empty() && keep.size() != shell.size())
        throw InvalidInput("reinforce: " + std::to_string(keep.size()) + " kept marks for a shell of " +
                           std::to_string(shell.size()) + " voxels");
    check_profile(shell, profile);
    impl_ = std::make_unique<Impl>(shell, profile, material, settings, std::move(keep));
}
StructuralOptimizer::~StructuralOptimizer() = default;
StructuralOptimizer::StructuralOptimizer(StructuralOptimizer&&) noexcept = default;
StructuralOptimizer& StructuralOptimizer::operator=(StructuralOptimizer&&) noexcept = default;

ReinforceStep StructuralOptimizer::step(const SolidStates& solid, const RunControl& run) {
    Impl& self = *impl_;
    if (solid.size() != self.shell.size())
        throw InvalidInput("reinforce: " + std::to_string(solid.size()) + " states for a shell of " +
                           std::to_string(self.shell.size()) + " voxels");
    run.checkpoint("structure", 0.0);
    const bool printed = self.settings.rules == ReinforceRules::kPaper;
    const bool last = self.iteration + 1 >= self.settings.max_iterations;
    ReinforceStep result;
    Impl::Outcome outcome;
    outcome.frozen_median_pa = self.frozen_median_pa;
    outcome.voxels_left = self.voxels_left;
    outcome.progress = self.progress;
    outcome.sample_radius = self.sample_radius;
    outcome.record.iteration = self.iteration + 1;
    outcome.record.allowable_pa = self.allowable_pa();

    SolidStates state = self.with_forced(solid);
    DroppedSpecks specks;
    SolidStates without_specks = state;
    parallel_for(2, 1, [&](std::size_t task) {
        if (task == 0)
            outcome.record.components_before =
                connected_components(self.shell.adjacency, state, SolidState::kSolid).count();
        else if (!printed)
            specks = self.drop(without_specks);
    });
    state = std::move(without_specks);
    result.dropped = std::move(specks.voxels);
    outcome.record.specks_dropped = specks.pieces;
    // A component that has a piece keeps one.
    const bool one_piece_each =
        !printed && specks.pieces_left == self.shell_components.count() && self.every_component_has_solid(state);
    if (last || !(printed || one_piece_each)) self.connect_and_seed(state, outcome, run);
    if (last)
        self.take_stock(state, outcome, run);
    else if (printed)
        self.reinforce_as_printed(state, outcome, run);
    else
        self.reinforce(state, outcome, run);
    self.connect_and_seed(state, outcome, run);
    result.done = last || !outcome.asks_for_resynthesis;
    if (result.done) {
        const std::vector<VoxelIndex> contacts = repair_contacts(self.shell, self.firm, state);
        outcome.covered.insert(outcome.covered.end(), contacts.begin(), contacts.end());
        outcome.record.stopped_by = last ? "iterations" : outcome.stopped_by;
    }
    // A bridge may have gone over a dropped speck.
    std::erase_if(result.dropped, [&](VoxelIndex v) { return state[v] == SolidState::kSolid; });
    run.checkpoint("structure", 1.0);

    self.commit(solid, outcome, result);
    result.scored = std::move(outcome.scored);
    return result;
}

}  // namespace fretwork
