// Lets the vertices on the wall's edges leave their lattice cells where that is safe.
#pragma once

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/solidify/marching_tets.h"

namespace fretwork {

/// Rounds all positions to float, with feature vertices moved to their targets. A move is taken back where it turns a
/// triangle over or makes triangles meet: what has changed is checked with exact predicates until nothing meets, so
/// that the result is as free of self-intersections as the lattice mesh is by construction.
TriangleMesh sharpened_mesh(const WallMesh& wall, double voxel_mm, const RunControl& run);

}  // namespace fretwork
