// Stage 6: REINFORCEMENTBRIDGES, one call of it.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "core/base/run_control.h"
#include "core/fem/beam_model.h"
#include "core/fem/force_profile.h"
#include "core/fem/material.h"
#include "core/graph/abstract_graph.h"
#include "core/reinforce/bridge.h"
#include "core/reinforce/paint_bridges.h"
#include "core/reinforce/select_bridges.h"
#include "core/reinforce/structural_optimizer.h"
#include "core/shell/components.h"

namespace fretwork {

/// What stays the same over all turns.
struct ReinforceContext {
    const SurfaceVoxels& shell;
    const Adjacency& firm;
    const ShellComponents& shell_components;
    const ForceProfile& profile;
    const Material& material;
    const ReinforceSettings& settings;
    const std::vector<VoxelIndex>& facing;  ///< of `facing_voxels`
};

/// Works on a pattern for the length of one turn: abstract graph, beam model, then bridges by one
/// criterion after the other. Solid voxels are added to the pattern that was handed in.
class ReinforcementTurn {
  public:
    /// GENERATEABSTRACTGRAPH and the beam model. Turns are sampled with seeds of their own, so that what one of them
    /// has reinforced is judged at other places by the next.
    /// \param state               updated by bridges; must outlive the turn
    /// \param iteration           number of the turn
    /// \param sample_radius       of the turn before, per component of the shell, or empty; replaced by this turn's
    ReinforcementTurn(const ReinforceContext& context, BridgePainter& painter, SolidStates& state, int iteration,
                      std::vector<double>& sample_radius, const RunControl& run);

    /// Scores of the pattern as it is now, into the record; the beam model is solved once. To be called first.
    void take_stock(const RunControl& run);

    /// Solid edges with the scores of the last stock-taking.
    [[nodiscard]] ScoredPaths scored_paths() const;

    /// As printed: the edges of highest score that join two pieces, until all are joined.
    void connect_by_score(const RunControl& run);

    /// As printed: bridges until no edge, empty ones included, is above `limit_pa` or none is empty.
    void stress_as_printed(double limit_pa, const RunControl& run);

    /// At most `rounds` times: solid edges above the aim, a share of `limit_pa`, are widened in proportion to their
    /// score, as for a fully stressed design; where nothing is left to widen, bridges are built over the empty edges
    /// of highest score. Ends when no solid edge is above the aim, candidates run out or the budget is spent.
    /// \param voxels_left  reduced by what is painted
    void stress_within_budget(double limit_pa, int rounds, std::size_t& voxels_left, const RunControl& run);

    /// Bridges wherever the way round is longer than `geodesic_factor` times the extent of the component.
    void geodesics(std::size_t& voxels_left, const RunControl& run);

    /// Paints the bridges that the printed rules have selected, all at the end.
    void paint_selected();

    [[nodiscard]] const ReinforceRecord& record() const { return record_; }
    [[nodiscard]] bool out_of_budget() const { return out_of_budget_; }
    [[nodiscard]] bool out_of_candidates() const { return out_of_candidates_; }
    [[nodiscard]] std::size_t bridges() const { return bridges_.size(); }
    /// Voxels of the painted bridges, with repeats.
    [[nodiscard]] const std::vector<VoxelIndex>& covered() const { return covered_; }

  private:
    void build_graph(int iteration, std::vector<double>& sample_radius, const RunControl& run);
    void renew_scores(const RunControl& run);
    void add(EdgeIndex e, BridgeReason reason);
    bool paint_within(EdgeIndex e, BridgeReason reason, std::size_t& voxels_left);
    enum class Widened { kYes, kNothingLeft, kNoBudget };
    Widened widen_strand(EdgeIndex e, double factor, std::size_t& voxels_left);
    bool widen_or_bridge(const std::vector<EdgeIndex>& over, double aim_pa, std::size_t& voxels_left);
    [[nodiscard]] std::vector<EdgeIndex> solid_edges_above(double score_pa) const;
    void close_filled_gaps();
    [[nodiscard]] std::vector<EdgeIndex> empty_edges() const;
    [[nodiscard]] std::vector<double> geodesic_limits() const;

    const ReinforceContext& context_;
    BridgePainter& painter_;
    SolidStates& state_;
    AbstractGraph graph_;
    EdgePlaces places_;
    std::optional<BeamModel> model_;
    std::vector<EdgeState> states_;
    std::vector<double> scores_pa_;
    std::vector<double> strand_half_voxels_;  ///< per edge; negative until it is widened
    std::vector<Bridge> bridges_;
    std::vector<VoxelIndex> covered_;
    ReinforceRecord record_;
    bool out_of_budget_ = false;
    bool out_of_candidates_ = false;
};

}  // namespace fretwork
