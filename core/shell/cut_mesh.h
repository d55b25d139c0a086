// Inside of VOXELIZE: all triangles cut at the cells of the grid, sorted by layer.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/bulk_vector.h"
#include "core/base/run_control.h"
#include "core/shell/triangle_cells.h"

namespace fretwork {

/// Patches with z = k are patches[first[k] .. first[k + 1]); within a layer their triangles ascend.
struct LayeredPatches {
    std::vector<std::size_t> first;
    BulkVector<Patch> patches;
};

/// Cost: linear in the patches and the triangles; both are shared out evenly between the threads.
/// \throws MemoryLimit  2^32 patches or more.
/// \throws Cancelled    `run` asked to stop.
LayeredPatches cut_mesh(const GriddedMesh& mesh, const VoxelCoord& extent, const RunControl& run);

}  // namespace fretwork
