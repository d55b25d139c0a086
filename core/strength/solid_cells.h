// Stage 10a: closed mesh -> cells of a grid whose centres are inside. Internal to this folder and its tests.
#pragma once

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/strength/cell_index.h"

namespace fretwork {

/// Takes the cells around whose centres the surface winds at least once. Each row of centres along x is one scan line;
/// which triangles it passes through is decided in integers (2^-18 of a cell), with one rule for lines that meet an
/// edge or a corner, so that no line slips through a closed surface or counts it twice.
/// Cost  about 0.1 s per million triangles and 256 layers, on all threads.
/// \param grid  at most 4096 cells along each axis; the mesh lies in it
/// \throws Cancelled  `run` asked to stop.
CellIndex solid_cells(const TriangleMesh& mesh, const VoxelGrid& grid, const RunControl& run = {});

}  // namespace fretwork
