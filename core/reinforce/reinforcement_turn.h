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
};

/// Works on a pattern for the length of one turn: abstract graph, beam model, then bridges by one
/// criterion after the other. Solid voxels are added to the pattern that was handed in.
class ReinforcementTurn {
  public:
    /// GENERATEABSTRACTGRAPH and the beam model. \param state  updated by bridges; must outlive the turn
    ReinforcementTurn(const ReinforceContext& context, BridgePainter& painter, SolidStates& state,
                      const RunControl& run);

    /// Scores of the pattern as it is now, into the record; the beam model is solved once. To be called first.
    void take_stock(const RunControl& run);

    /// As printed: the edges of highest score that join two pieces, until all are joined.
    void connect_by_score(const RunControl& run);

    /// As printed: bridges until no edge, empty ones included, is above `limit_pa` or none is empty.
    void stress_as_printed(double limit_pa, const RunControl& run);

    /// At most `solutions` batches of bridges, until no solid edge is above `limit_pa`, candidates run out or
    /// the next bridge does not fit the budget.
    /// \param voxels_left  reduced by what is painted
    void stress_within_budget(double limit_pa, int solutions, std::size_t& voxels_left, const RunControl& run);

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
    void renew_scores(const RunControl& run);
    void add(EdgeIndex e, BridgeReason reason);
    bool paint_within(EdgeIndex e, BridgeReason reason, std::size_t& voxels_left);
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
    std::vector<Bridge> bridges_;
    std::vector<VoxelIndex> covered_;
    ReinforceRecord record_;
    bool out_of_budget_ = false;
    bool out_of_candidates_ = false;
};

}  // namespace fretwork
