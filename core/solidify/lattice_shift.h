// Keeps the lattice's nodes off flat faces of the object.
#pragma once

#include "core/mesh/triangle_mesh.h"
#include "core/shell/surface_voxels.h"
#include "core/solidify/wall_field.h"

namespace fretwork {

/// Offset of the lattice against the shell's grid, in voxels in [0, 1) per axis: as far as can be from every large
/// triangle that lies square to the axis, and from where the wall's other face runs beside it. A node plane that
/// coincides with a flat face would put its vertices on the nodes, where they are clamped.
Vec3 lattice_shift(const TriangleMesh& mesh, const VoxelGrid& grid, const WallLimits& limits);

}  // namespace fretwork
