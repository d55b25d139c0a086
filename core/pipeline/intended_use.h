// `structure.profile`, [[loads]] and [[fixtures]] -> the force profile of the structural steps.
#pragma once

#include "core/base/run_control.h"
#include "core/fem/force_profile.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/settings.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// kAuto becomes own loads where there are any, gravity under the paper's rules, handling otherwise.
LoadProfile chosen_profile(const Settings& settings);

/// The cases of the profile, then the drop, then the grips; each held by its fixtures, or by its base. Last, where
/// supports are to be taken away, each of these cases without one of them. \param mesh  the one `shell` was made from
/// \throws ConstraintsNotMet  profile "own" without loads; a fixture that names a case without loads; a drop by height
///                            and by factor; grips on a surface that has no two sides; a support to be taken away from
///                            an object that has one.
/// \throws InvalidSetting     a region that meets no part of the surface.
ForceProfile intended_use(const TriangleMesh& mesh, const SurfaceVoxels& shell, const Settings& settings,
                          const RunControl& run = {});

}  // namespace fretwork
