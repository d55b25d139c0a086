// The loop of Algorithm 1: structural step, resynthesis, until nothing is left to reinforce.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/exemplar.h"
#include "core/pipeline/resolve_settings.h"
#include "core/reinforce/structural_optimizer.h"
#include "core/shell/surface_voxels.h"
#include "core/synthesis/synthesizer.h"

namespace fretwork {

struct StructureLoopResult {
    SolidStates solid;
    std::vector<std::uint8_t> forced;  ///< one byte per voxel: made solid by the structural steps
    std::vector<ReinforceRecord> records;
    ScoredPaths first_scored, last_scored;  ///< of the first and of the last turn
    std::size_t components_before = 0;      ///< pieces of the first synthesis
    double seconds_structure = 0.0;
    double seconds_resynthesis = 0.0;
};

/// Pieces of the solid voxels over firm links, all components of the mesh together.
std::size_t count_pieces(const SurfaceVoxels& shell, const SolidStates& solid);

/// States of the synthesised pattern with what must be solid laid over it.
SolidStates solid_with(const Exemplar& exemplar, const TexelFrames& frames, const std::vector<std::uint8_t>& keep,
                       const std::vector<std::uint8_t>& forced);

/// `keep`  one byte per voxel that is solid whatever the pattern says.
/// Ends when the optimizer is done, after `structure.max_iterations` turns at the latest, in one piece per
/// component of the mesh.
StructureLoopResult structure_loop(const SurfaceVoxels& shell, const Exemplar& exemplar, Synthesizer& synthesizer,
                                   const ForceProfile& profile, const ResolvedSettings& settings,
                                   const std::vector<std::uint8_t>& keep, const RunControl& run);

}  // namespace fretwork
