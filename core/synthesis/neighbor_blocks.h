// N(v) of the paper, laid out for the inner loop: eight neighbours per block.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/bulk_vector.h"
#include "core/pyramid/voxel_pyramid.h"
#include "core/synthesis/subpasses.h"

namespace fretwork {

/// Offsets as in LevelOffset. Unused lanes repeat the voxel itself with zero offsets.
struct NeighborBlock {
    std::int32_t out_xy[8];   ///< from the voxel to its neighbour, in the voxel's tangent plane
    std::int32_t back_xy[8];  ///< from the neighbour to the voxel, in the neighbour's
    std::int32_t z[8];        ///< of `out` in the lower half, of `back` in the upper
    std::uint32_t neighbor[8];
};

/// Blocks lie in the order in which the voxels are visited.
struct NeighborBlocks {
    std::vector<std::uint32_t> first;  ///< per voxel
    std::vector<std::uint16_t> count;  ///< |N(v)|
    BulkVector<NeighborBlock> blocks;
};

/// Most neighbours that are looked at; a 5x5x5 cube holds 124, more only where sheets meet in it.
inline constexpr int kMaxNeighbors = 248;

NeighborBlocks pack_neighbors(const PyramidLevel& level, int level_index, const Subpasses& subpasses);

}  // namespace fretwork
