// How wide the material and the gaps are around points of a surface. Internal to this folder and its tests.
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/closest_point.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

enum class WallSide { kMaterial, kGap };

/// Width at one point; `limit_mm` where it is at least that or where no wall stands opposite.
struct WallWidth {
    Vec3 at_mm = Vec3::Zero();
    double width_mm = 0.0;
};

/// At points spread evenly over the surface, the way straight through the material (or the gap) to the other wall. Only
/// walls that face each other tell a width, to within 30 degrees: near edges the way ends at a neighbouring wall
/// however wide the strand is.
/// Cost  a few microseconds per point, on all threads.
std::vector<WallWidth> wall_widths(const TriangleMesh& mesh, const SurfaceTree& tree, WallSide side, double limit_mm,
                                   const RunControl& run);

}  // namespace fretwork
