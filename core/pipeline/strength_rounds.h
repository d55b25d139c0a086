// The closing loop: what the full analysis finds weak is strengthened, until the asked safety holds or cannot.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/base/run_control.h"
#include "core/enlarge/enlarge_features.h"
#include "core/pipeline/carve_trace.h"
#include "core/pipeline/run_report.h"
#include "core/pipeline/shell_strength.h"
#include "core/solidify/solidify.h"
#include "core/synthesis/labels.h"

namespace fretwork {

/// A pattern and the object that was made of it.
struct MadeObject {
    std::vector<std::uint8_t> forced;  ///< one byte per voxel: made solid by structural steps
    TexelFrames frames;
    EnlargeResult enlarged;
    CarvedMesh carved;
};

/// The object once `added` are forced as well; `forced` holds them already.
using MakeObject = std::function<MadeObject(std::vector<std::uint8_t> forced, const std::vector<VoxelIndex>& added,
                                            const RunControl& run)>;

struct StrengthRoundSettings {
    int rounds = 8;            ///< objects that may be made anew
    double budget = 0.15;      ///< most voxels to be added, share of the shell's
    double most_voxels = 6.0;  ///< that a border moves outward in a round
    StrengthCheckSettings check;
};

struct StrengthRounds {
    MadeObject object;  ///< the strongest of all rounds
    StrengthRecord record;
    ShellStrength first, on_shell;  ///< of the object that came in, and of that one
};

/// What the full analysis says of the object before the rounds and after them.
ShellStress analyzed_stress(const StrengthRounds& rounds, const Material& material);

/// Ends when the least factor of safety is the asked one; after the last round; when the budget is spent or all around
/// the weak places is solid; or when two rounds have not made it 2 % stronger.
/// Same in, same out for any number of threads. Cost: an analysis and a `make` per round.
/// \throws  as check_strength and `make`
StrengthRounds strengthen(MadeObject object, const SurfaceVoxels& shell, const GeodesicLinks& links,
                          const SurfaceLoads& loads, const StrengthRoundSettings& settings, const MakeObject& make,
                          const RunControl& run);

}  // namespace fretwork
