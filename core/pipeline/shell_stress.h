// From scores of edges of the abstract graph (section 5.2.1) to stress on the shell.
#pragma once

#include "core/pipeline/carve_trace.h"
#include "core/pipeline/structure_loop.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Scores of solid edges on the voxels: those on paths have the highest of their edges, other solid voxels that of
/// the nearest path, counted in links within the pattern.
/// \param solid  states of the pattern that was scored; voxels of paths count as solid whatever it says
/// Cost  linear in the links of the shell
StressField stress_on_voxels(const SurfaceVoxels& shell, const SolidStates& solid, const ScoredPaths& scored);

/// What the finite elements of the reinforcement loop say of the connected pattern, before the first and after the
/// last bridge against stress.
ShellStress design_stress(const SurfaceVoxels& shell, const SolidStates& first_solid, const StructureLoopResult& loop);

}  // namespace fretwork
