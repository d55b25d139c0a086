#include "core/reinforce/reinforcement_turn.h"

#include <algorithm>
#include <array>
#include <limits>

#include "core/graph/connect_samples.h"
#include "core/graph/poisson_disk.h"
#include "core/reinforce/force_profile_score.h"
#include "core/reinforce/geodesic_score.h"

namespace fretwork {
namespace {

/// "The radius of cancellation is twice the length of the already inserted edge."
constexpr double kCancelFactor = 2.0;

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
                                     const RunControl& run)
    : context_(context), painter_(painter), state_(state) {
    const SurfaceVoxels& shell = context.shell;
    const ReinforceSettings& settings = context.settings;
    SampleSettings sampling;
    sampling.target = static_cast<std::size_t>(settings.samples);
    sampling.seed = settings.seed;
    Samples samples = poisson_samples(shell.adjacency, context.shell_components, state, sampling, run);
    run.checkpoint("structure", 0.1);
    const bool printed = settings.rules == ReinforceRules::kPaper;
    graph_ = connect_samples(shell.adjacency, state, std::move(samples.voxels),
                             printed ? ExtendFrom::kSource : ExtendFrom::kTree, run);
    places_ = edge_places(shell, graph_);
    run.checkpoint("structure", 0.2);
    BeamModelSettings model;
    model.thickness_mm = settings.thickness_mm;
    model.soft_factor = settings.soft_factor;
    model.bridge_half_width_voxels = settings.pattern_radius_voxels;
    model_.emplace(shell, state, graph_, context.profile, context.material, model, run);
    for (const AbstractEdge& edge : graph_.edges) states_.push_back(edge.state);
    run.checkpoint("structure", 0.4);
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

void ReinforcementTurn::stress_within_budget(double limit_pa, int solutions, std::size_t& voxels_left,
                                             const RunControl& run) {
    for (int solution = 0;; ++solution) {
        const ScoreSummary summary = summarize_solid_scores(scores_pa_, states_);
        if (summary.max_pa <= limit_pa) return;
        // The farther from the limit, the larger the batch: one bridge for every three edges above it.
        std::size_t above = 0;
        for (std::size_t e = 0; e < states_.size(); ++e)
            above += states_[e] == EdgeState::kSolid && scores_pa_[e] > limit_pa ? 1u : 0u;
        const auto least = static_cast<std::size_t>(context_.settings.batch);
        const std::size_t most = std::clamp(above / 3, least, 4 * least);
        const std::vector<EdgeIndex> taken = select_bridges(places_, scores_pa_, empty_edges(), most, kCancelFactor);
        if (taken.empty()) {
            out_of_candidates_ = true;
            return;
        }
        for (const EdgeIndex e : taken)
            if (!paint_within(e, BridgeReason::kStress, voxels_left)) return;
        close_filled_gaps();
        if (solution + 1 == solutions) return;
        renew_scores(run);
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
