// Stage 5b: where a model is thin, walls of opposite sheets grow into each other and bear loads together.
#pragma once

#include <vector>

#include "core/graph/abstract_graph.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// The nearest voxel straight inside `v`, on a sheet that faces away (normals more than 107 degrees apart); kNoVoxel
/// where there is none within `reach_mm`.
VoxelIndex facing_voxel(const SurfaceVoxels& shell, VoxelIndex v, double reach_mm);

/// Of each voxel the one it faces, if its wall touches its own: not farther than twice `depth_mm`. A matter of the
/// shell alone. Cost: about a tenth of a microsecond per voxel and voxel of depth; parallel.
/// \param depth_mm  how far walls reach inside the surface; 0 or less: none meet
std::vector<VoxelIndex> facing_voxels(const SurfaceVoxels& shell, double depth_mm);

/// Walls of two samples' regions that are one body.
struct SheetTie {
    SampleIndex a = 0, b = 0;  ///< a < b
    double area_mm2 = 0.0;     ///< over which they are joined
};

/// Ties between samples of solid voxels that face each other, by (a, b). Areas of a few voxels are left out.
/// \param facing  of `facing_voxels`; may be empty
std::vector<SheetTie> sheet_ties(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                                 const std::vector<VoxelIndex>& facing);

}  // namespace fretwork
