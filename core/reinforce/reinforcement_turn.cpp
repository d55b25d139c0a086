#include "core/reinforce/reinforcement_turn.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "core/base/parallel.h"
#include "core/fem/beam_widths.h"
#include "core/graph/connect_samples.h"
#include "core/graph/poisson_disk.h"
#include "core/reinforce/force_profile_score.h"
#include "core/reinforce/geodesic_score.h"

namespace fretwork {
namespace {

/// "The radius of cancellation is twice the length of the already inserted edge."
constexpr double kCancelFactor = 2.0;

/// Reinforcement goes on to this share of the limit: the next turn looks at other samples and finds up to half more.
constexpr double kAim = 0.65;

/// An edge far above the aim is not widened by more than this at once, since others will take a share of its load.
constexpr double kMostWidening = 2.0;

/// For each edge above the aim around which everything is solid already.
constexpr std::size_t kBridgesPerStuckEdge = 2;

double harmonic_half_width(std::span<const VoxelIndex> path, const std::vector<float>& half_width) {
    double sum = 0.0;
    for (const VoxelIndex v : path) sum += 1.0 / std::max(0.5, static_cast<double>(half_width[v]));
    return static_cast<double>(path.size()) / sum;
}

/// Longest side of each component's box, in voxels.
std::vector<double> component_extents(const SurfaceVoxels& shell, const ShellComponents& components) {
    constexpr auto kLow = std::numeric_limits<std::int32_t>::min();
    constexpr auto kHigh = std::numeric_limits<std::int32_t>::max();
    std::vector<VoxelCoord> least(components.count(), {kHigh, kHigh, kHigh});
    std::vector<VoxelCoord> most(components.count(), {kLow, kLow, kLow});
    for (std::size_t v = 0; v < shell.size(); ++v)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::uint32_t c = components.of[v];
            least[c][axis] = std::min(least[c][axis], shell.coords[v][axis]);
            most[c][axis] = std::max(most[c][axis], shell.coords[v][axis]);
        }
    std::vector<double> extent(components.count(), 1.0);
    for (std::size_t c = 0; c < extent.size(); ++c)
        for (std::size_t axis = 0; axis < 3; ++axis)
            extent[c] = std::max(extent[c], static_cast<double>(most[c][axis] - least[c][axis] + 1));
    return extent;
}

}  // namespace

ReinforcementTurn::ReinforcementTurn(const ReinforceContext& context, BridgePainter& painter, SolidStates& state,
                                     int iteration, std::vector<double>& sample_radius, const RunControl& run)
    : context_(context), painter_(painter), state_(state) {
    const SurfaceVoxels& shell = context.shell;
    const ReinforceSettings& settings = context.settings;
    // The two do not need each other, and neither has enough loops to keep all threads busy.
    std::vector<float> half_width_voxels;
    parallel_for(2, 1, [&](std::size_t task) {
        if (task == 0)
            build_graph(iteration, sample_radius, run);
        else
            half_width_voxels = beam_half_widths(shell, state);
    });
    run.checkpoint("structure", 0.2);
    places_ = edge_places(shell, graph_);
    BeamModelSettings model;
    model.thickness_mm = settings.thickness_mm;
    model.soft_factor = settings.soft_factor;
    model.bridge_half_width_voxels = settings.pattern_radius_voxels;
    model.facing = context.facing;
    model_.emplace(shell, state, graph_, std::move(half_width_voxels), context.profile, context.material, model, run);
    for (const AbstractEdge& edge : graph_.edges) states_.push_back(edge.state);
    run.checkpoint("structure", 0.4);
}

void ReinforcementTurn::build_graph(int iteration, std::vector<double>& sample_radius, const RunControl& run) {
    const Adjacency& surface = context_.shell.adjacency;
    SampleSettings sampling;
    sampling.target = static_cast<std::size_t>(context_.settings.samples);
    sampling.seed = context_.settings.seed + static_cast<std::uint64_t>(iteration) - 1;
    sampling.start_radius_voxels = sample_radius;
    Samples samples = poisson_samples(surface, context_.shell_components, state_, sampling, run);
    sample_radius = samples.radius_voxels;
    const bool printed = context_.settings.rules == ReinforceRules::kPaper;
    graph_ = connect_samples(surface, state_, std::move(samples.voxels),
                             printed ? ExtendFrom::kSource : ExtendFrom::kTree, run);
}

void ReinforcementTurn::renew_scores(const RunControl& run) {
    scores_pa_ = model_->edge_scores_pa(states_, run);
}

void ReinforcementTurn::take_stock(const RunControl& run) {
    renew_scores(run);
    const ScoreSummary summary = summarize_solid_scores(scores_pa_, states_);
    record_.max_score_pa = summary.max_pa;
    record_.p99_score_pa = summary.p99_pa;
    record_.median_score_pa = summary.median_pa;
    record_.average_score_pa = summary.average_pa;
    run.checkpoint("structure", 0.6);
}

ScoredPaths ReinforcementTurn::scored_paths() const {
    ScoredPaths scored;
    scored.first.push_back(0);
    for (EdgeIndex e = 0; e < states_.size(); ++e) {
        if (states_[e] != EdgeState::kSolid) continue;
        const std::span<const VoxelIndex> path = graph_.voxel_path(e);
        scored.scores_pa.push_back(scores_pa_[e]);
        scored.voxels.insert(scored.voxels.end(), path.begin(), path.end());
        scored.first.push_back(static_cast<std::uint32_t>(scored.voxels.size()));
    }
    return scored;
}

std::vector<EdgeIndex> ReinforcementTurn::empty_edges() const {
    std::vector<EdgeIndex> empty;
    for (EdgeIndex e = 0; e < states_.size(); ++e)
        if (states_[e] == EdgeState::kEmpty) empty.push_back(e);
    return empty;
}

void ReinforcementTurn::add(EdgeIndex e, BridgeReason reason) {
    states_[e] = EdgeState::kSolid;
    bridges_.push_back({e, reason});
    switch (reason) {
        case BridgeReason::kConnect:
            ++record_.bridges_connect;
            break;
        case BridgeReason::kStress:
            ++record_.bridges_stress;
            break;
        case BridgeReason::kGeodesic:
            ++record_.bridges_geodesic;
            break;
    }
}

void ReinforcementTurn::connect_by_score(const RunControl& run) {
    while (true) {
        const std::vector<EdgeIndex> taken = select_connections(graph_, states_, places_, scores_pa_, kCancelFactor);
        if (taken.empty()) return;
        for (const EdgeIndex e : taken) add(e, BridgeReason::kConnect);
        renew_scores(run);
    }
}

void ReinforcementTurn::stress_as_printed(double limit_pa, const RunControl& run) {
    while (highest_score_pa(scores_pa_) > limit_pa) {
        const std::vector<EdgeIndex> candidates = empty_edges();
        const std::vector<EdgeIndex> taken =
            select_bridges(places_, scores_pa_, candidates, candidates.size(), kCancelFactor);
        if (taken.empty()) {
            out_of_candidates_ = true;
            return;
        }
        for (const EdgeIndex e : taken) add(e, BridgeReason::kStress);
        renew_scores(run);
    }
}

std::vector<EdgeIndex> ReinforcementTurn::solid_edges_above(double score_pa) const {
    std::vector<EdgeIndex> above;
    for (EdgeIndex e = 0; e < states_.size(); ++e)
        if (states_[e] == EdgeState::kSolid && scores_pa_[e] > score_pa) above.push_back(e);
    std::ranges::sort(above, [&](EdgeIndex x, EdgeIndex y) {
        return scores_pa_[x] != scores_pa_[y] ? scores_pa_[x] > scores_pa_[y] : x < y;
    });
    return above;
}

ReinforcementTurn::Widened ReinforcementTurn::widen_strand(EdgeIndex e, double factor, std::size_t& voxels_left) {
    const std::vector<float>& half_width = model_->half_width_voxels();
    const double bridge = context_.settings.pattern_radius_voxels;
    double& half = strand_half_voxels_[e];
    if (half < 0.0) half = harmonic_half_width(graph_.voxel_path(e), half_width);
    const double wanted = std::min(half + 2.0 * bridge, std::max(bridge, half * factor));
    std::vector<VoxelIndex> thin;
    for (const VoxelIndex v : graph_.voxel_path(e))
        if (static_cast<double>(half_width[v]) < wanted) thin.push_back(v);
    const PaintedVoxels painted = painter_.paint_strand(thin, wanted, state_);
    if (painted.added.size() > voxels_left) {
        for (const VoxelIndex v : painted.added) state_[v] = SolidState::kEmpty;
        out_of_budget_ = true;
        return Widened::kNoBudget;
    }
    if (painted.added.empty()) return Widened::kNothingLeft;
    voxels_left -= painted.added.size();
    covered_.insert(covered_.end(), painted.covered.begin(), painted.covered.end());
    // A strand gets the width that was painted; in a sheet, which many edges share, the edge's part grows alike.
    const bool is_strand = half < bridge;
    model_->widen(e, is_strand ? 2.0 * wanted * context_.shell.grid.voxel_mm : model_->width_mm(e) * wanted / half);
    half = wanted;
    bridges_.push_back({e, BridgeReason::kStress});
    ++record_.bridges_stress;
    return Widened::kYes;
}

bool ReinforcementTurn::widen_or_bridge(const std::vector<EdgeIndex>& over, double aim_pa, std::size_t& voxels_left) {
    std::size_t stuck = 0;
    for (const EdgeIndex e : over) {
        const Widened widened = widen_strand(e, std::min(kMostWidening, scores_pa_[e] / aim_pa), voxels_left);
        if (widened == Widened::kNoBudget) return false;
        if (widened == Widened::kNothingLeft) ++stuck;
    }
    const std::size_t most =
        std::min(kBridgesPerStuckEdge * stuck, 4 * static_cast<std::size_t>(context_.settings.batch));
    const std::vector<EdgeIndex> taken = select_bridges(places_, scores_pa_, empty_edges(), most, kCancelFactor);
    if (taken.empty() && stuck == over.size()) {
        out_of_candidates_ = true;
        return false;
    }
    return std::ranges::all_of(taken, [&](EdgeIndex e) { return paint_within(e, BridgeReason::kStress, voxels_left); });
}

void ReinforcementTurn::stress_within_budget(double limit_pa, int rounds, std::size_t& voxels_left,
                                             const RunControl& run) {
    strand_half_voxels_.assign(states_.size(), -1.0);
    for (int round = 0; round < rounds; ++round) {
        // What the last round has gained, the next turn sees.
        if (round > 0) renew_scores(run);
        const std::vector<EdgeIndex> over = solid_edges_above(kAim * limit_pa);
        if (over.empty()) return;
        if (!widen_or_bridge(over, kAim * limit_pa, voxels_left)) return;
        close_filled_gaps();
    }
}

bool ReinforcementTurn::paint_within(EdgeIndex e, BridgeReason reason, std::size_t& voxels_left) {
    const PaintedVoxels painted = painter_.paint(graph_.voxel_path(e), DilatedPart::kGap, state_);
    if (painted.added.size() > voxels_left) {
        for (const VoxelIndex v : painted.added) state_[v] = SolidState::kEmpty;
        out_of_budget_ = true;
        return false;
    }
    voxels_left -= painted.added.size();
    covered_.insert(covered_.end(), painted.covered.begin(), painted.covered.end());
    add(e, reason);
    return true;
}

void ReinforcementTurn::close_filled_gaps() {
    for (EdgeIndex e = 0; e < states_.size(); ++e) {
        if (states_[e] == EdgeState::kSolid) continue;
        const auto is_solid = [&](VoxelIndex v) { return state_[v] == SolidState::kSolid; };
        if (std::ranges::all_of(graph_.voxel_path(e), is_solid)) states_[e] = EdgeState::kSolid;
    }
}

std::vector<double> ReinforcementTurn::geodesic_limits() const {
    const std::vector<double> extent = component_extents(context_.shell, context_.shell_components);
    std::vector<double> limits;
    for (const AbstractEdge& edge : graph_.edges)
        limits.push_back(context_.settings.geodesic_factor *
                         extent[context_.shell_components.of[graph_.samples[edge.a]]]);
    return limits;
}

void ReinforcementTurn::geodesics(std::size_t& voxels_left, const RunControl& run) {
    const bool printed = context_.settings.rules == ReinforceRules::kPaper;
    const auto build = [&](EdgeIndex e) {
        if (!printed) return paint_within(e, BridgeReason::kGeodesic, voxels_left);
        add(e, BridgeReason::kGeodesic);
        return true;
    };
    const double highest = select_by_geodesics(graph_, geodesic_limits(), states_, build, run);
    record_.max_geodesic = highest * context_.settings.geodesic_factor;
}

void ReinforcementTurn::paint_selected() {
    for (const Bridge& bridge : bridges_) {
        const PaintedVoxels painted = painter_.paint(graph_.voxel_path(bridge.edge), DilatedPart::kWholePath, state_);
        covered_.insert(covered_.end(), painted.covered.begin(), painted.covered.end());
    }
}

}  // namespace fretwork
