// Stage 4e: how wide the pattern is, place by place.
#pragma once

#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Half of the width of the pattern around each solid voxel, in voxels: the distance to the nearest
/// empty voxel, less half a voxel, taken at the middle of the strand the voxel lies on. The middle is
/// found by climbing that distance for as long as it rises as steeply as it does away from a
/// border; along the middle it does not.
///
/// Empty voxels get 0. Where no empty voxel can be reached, `widest_voxels`, which also bounds every value.
/// Cost: one pass over the links, and a few steps per solid voxel.
std::vector<float> pattern_half_width(const Adjacency& graph, const SolidStates& solid, double widest_voxels);

}  // namespace fretwork
