// One pattern on one model, reinforced in one of several ways, and how it bears its weight: what the benchmark of
// soundness looks at.
#pragma once

#include <cstddef>
#include <string>

#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/settings.h"
#include "core/strength/strength.h"

namespace fretwork::bench {

struct SoundnessRun {
    StressStatistics expected, unexpected;  ///< weight along -z and along x, every voxel a finite element
    double solid_fraction = 0.0;            ///< of the pattern as it is printed
    double volume_mm3 = 0.0;
    std::size_t solid_voxels = 0;  ///< before thin places are enlarged
    std::size_t bridges = 0, turns = 0;
    double patches_first = 0.0, patches = 0.0;  ///< patch similarity of the first synthesis and of the result
    double seams_first = 0.0, seams = 0.0;      ///< worst seams
};

/// As `carve` does it, of a built-in pattern.
SoundnessRun run_soundness(const TriangleMesh& mesh, const Settings& settings);

/// The naive scheme: the pattern is joined by its shortest gaps, as ours is, and then gets bridges of the pattern's
/// width over the gaps between samples of it, spread as evenly as can be (each as far as possible from all before), as
/// long as the pattern keeps below `solid_voxels`. No stress is looked at and nothing is synthesised again.
SoundnessRun run_naively(const TriangleMesh& mesh, Settings settings, std::size_t solid_voxels);

}  // namespace fretwork::bench
