// From voxels of the full analysis to the surface that was carved, and to that of the result.
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/strength_check.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Of each surface voxel the worst of the wall below it.
struct ShellStrength {
    std::vector<float> factor;      ///< of safety; kMostFactor where there is no wall
    std::vector<float> stress_mpa;  ///< |s1| + |s2| + |s3|; negative where there is no wall
};

/// Each voxel of the wall counts for the nearest solid voxel of the surface.
/// \param solid  states of the pattern that was analysed; at least one solid
/// Cost  some microseconds per voxel of the wall; parallel
ShellStrength strength_on_shell(const SurfaceVoxels& shell, const SolidStates& solid, const StrengthCheck& check,
                                const RunControl& run = {});

/// Of each triangle of the carved mesh the stress of the nearest voxel, the worst of all cases: |s1| + |s2| + |s3|,
/// MPa. \param check  with its values per voxel Cost  some microseconds per triangle; parallel
std::vector<double> stress_on_triangles(const TriangleMesh& carved, const StrengthCheck& check,
                                        const RunControl& run = {});

}  // namespace fretwork
