#include "core/reinforce/structural_optimizer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/base/error.h"
#include "core/graph/firm_links.h"
#include "core/reinforce/connect_pieces.h"
#include "core/reinforce/drop_specks.h"
#include "core/reinforce/paint_bridges.h"
#include "core/reinforce/repair_contacts.h"

namespace fretwork {

struct StructuralOptimizer::Impl {
    const SurfaceVoxels& shell;
    ReinforceSettings settings;
    std::vector<std::uint8_t> keep;
    Adjacency firm;
    ShellComponents shell_components;
    BridgePainter painter;
    SolidStates forced;
    int iteration = 0;

    Impl(const SurfaceVoxels& shell_in, const ReinforceSettings& settings_in, std::vector<std::uint8_t> keep_in)
        : shell(shell_in),
          settings(settings_in),
          keep(std::move(keep_in)),
          firm(firm_links(shell.adjacency)),
          shell_components(connected_components(shell.adjacency)),
          painter(shell, firm, settings.pattern_radius_voxels),
          forced(shell.size(), SolidState::kEmpty) {}
};

StructuralOptimizer::StructuralOptimizer(const SurfaceVoxels& shell, const ForceProfile&, const Material&,
                                         const ReinforceSettings& settings, std::vector<std::uint8_t> keep)
    : impl_(std::make_unique<Impl>(shell, settings, std::move(keep))) {}
StructuralOptimizer::~StructuralOptimizer() = default;
StructuralOptimizer::StructuralOptimizer(StructuralOptimizer&&) noexcept = default;
StructuralOptimizer& StructuralOptimizer::operator=(StructuralOptimizer&&) noexcept = default;

ReinforceStep StructuralOptimizer::step(const SolidStates& solid, const RunControl& run) {
    Impl& self = *impl_;
    SolidStates state = solid;
    for (std::size_t v = 0; v < state.size(); ++v)
        if (self.forced[v] == SolidState::kSolid) state[v] = SolidState::kSolid;
    ReinforceStep result;
    result.record.iteration = ++self.iteration;
    result.record.components_before = connected_components(self.shell.adjacency, solid, SolidState::kSolid).count();
    const double radius = self.settings.pattern_radius_voxels;
    const SpeckRules specks{static_cast<std::size_t>(std::numbers::pi * radius * radius), 0.2};
    DroppedSpecks dropped = drop_specks(self.firm, self.shell_components, self.keep, specks, state);
    result.dropped = std::move(dropped.voxels);
    result.record.specks_dropped = dropped.pieces;
    const auto seeds = seed_empty_components(self.shell_components, self.painter, 2 * radius, state);
    const ConnectedPieces connected =
        connect_pieces(self.shell, self.firm, self.painter, DilatedPart::kGap, state, run);
    result.record.bridges_connect = connected.bridges;
    result.done = seeds.empty() && connected.bridges == 0;
    if (result.done) repair_contacts(self.shell, self.firm, state);
    for (VoxelIndex v = 0; v < state.size(); ++v) {
        if (state[v] == SolidState::kEmpty || solid[v] == SolidState::kSolid) continue;
        result.forced_solid.push_back(v);
        self.forced[v] = SolidState::kSolid;
    }
    result.record.voxels_added = result.forced_solid.size();
    result.record.connected = true;
    return result;
}

}  // namespace fretwork
