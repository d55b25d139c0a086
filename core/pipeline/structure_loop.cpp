#include "core/pipeline/structure_loop.h"

#include <chrono>
#include <numeric>

#include "core/pipeline/stage_plan.h"
#include "core/reinforce/pattern_pieces.h"

namespace fretwork {
namespace {

using Clock = std::chrono::steady_clock;

// A run of the loop takes some five turns; each turn's slice of the progress is this share of the rest.
constexpr double kShareOfTurn = 0.3;
constexpr double kShareOfStructure = 0.7;  // within a turn, against the resynthesis

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void apply(const ReinforceStep& step, StructureLoopResult& result) {
    for (const VoxelIndex v : step.dropped) result.solid[v] = SolidState::kEmpty;
    for (const VoxelIndex v : step.forced_solid) {
        result.forced[v] = 1;
        result.solid[v] = SolidState::kSolid;
    }
}

}  // namespace

std::size_t count_pieces(const SurfaceVoxels& shell, const SolidStates& solid) {
    const PatternPieces pieces = pattern_pieces(shell, solid);
    return std::accumulate(pieces.firm.begin(), pieces.firm.end(), std::size_t{0});
}

SolidStates solid_with(const Exemplar& exemplar, const TexelFrames& frames, const std::vector<std::uint8_t>& keep,
                       const std::vector<std::uint8_t>& forced) {
    SolidStates solid = read_solid(exemplar, frames);
    for (std::size_t v = 0; v < solid.size(); ++v)
        if (keep[v] || forced[v]) solid[v] = SolidState::kSolid;
    return solid;
}

StructureLoopResult structure_loop(const SurfaceVoxels& shell, const Exemplar& exemplar, Synthesizer& synthesizer,
                                   const ForceProfile& profile, const ResolvedSettings& settings,
                                   const std::vector<std::uint8_t>& keep, const RunControl& run) {
    StructureLoopResult result;
    result.forced.assign(shell.size(), 0);
    result.solid = solid_with(exemplar, synthesizer.frames(), keep, result.forced);
    result.components_before = count_pieces(shell, result.solid);

    StructuralOptimizer optimizer(shell, profile, settings.material, settings.reinforce, keep);
    OpenEndedSlices slices(run, kShareOfTurn);
    while (true) {
        const RunControl turn = slices.next();
        Clock::time_point start = Clock::now();
        ReinforceStep step = optimizer.step(result.solid, turn.slice(0.0, kShareOfStructure));
        apply(step, result);
        result.records.push_back(step.record);
        if (result.records.size() == 1) result.first_scored = step.scored;
        result.last_scored = std::move(step.scored);
        result.seconds_structure += seconds_since(start);
        if (step.done) break;

        start = Clock::now();
        synthesizer.resynthesize(result.forced, step.forced_solid, settings.reinforce.pattern_radius_voxels,
                                 turn.slice(kShareOfStructure, 1.0));
        result.solid = solid_with(exemplar, synthesizer.frames(), keep, result.forced);
        result.seconds_resynthesis += seconds_since(start);
    }
    return result;
}

}  // namespace fretwork
