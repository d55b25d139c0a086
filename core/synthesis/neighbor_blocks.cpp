#include "core/synthesis/neighbor_blocks.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/synthesis/texel_map.h"

namespace fretwork {
namespace {

/// A coordinate of an offset: cells with 12 fractional bits.
std::int32_t to_cells(float voxels, float unit) {
    return round_to_int(std::clamp(voxels * unit, -32767.0F, 32767.0F));
}

void fill_lane(NeighborBlock& b, std::uint32_t lane, VoxelIndex neighbor, const Vec3f& out, const Vec3f& back,
               float unit) {
    b.out_xy[lane] = pack16(to_cells(out.x(), unit), to_cells(out.y(), unit));
    b.back_xy[lane] = pack16(to_cells(back.x(), unit), to_cells(back.y(), unit));
    b.z[lane] = pack16(to_cells(out.z(), unit), to_cells(back.z(), unit));
    b.neighbor[lane] = neighbor;
}

}  // namespace

NeighborBlocks pack_neighbors(const PyramidLevel& level, int level_index, const Subpasses& subpasses) {
    const Neighborhoods& n = level.neighborhoods;
    const std::size_t voxels = level.size();
    NeighborBlocks packed;
    packed.first.resize(voxels);
    packed.count.resize(voxels);
    std::uint32_t blocks = 0;
    for (const VoxelIndex v : subpasses.order) {
        const std::uint32_t count = std::min<std::uint32_t>(n.first[v + 1] - n.first[v], kMaxNeighbors);
        packed.first[v] = blocks;
        packed.count[v] = static_cast<std::uint16_t>(count);
        blocks += (count + 7) / 8;
    }
    packed.blocks.resize(blocks);

    const float unit = std::ldexp(4096.0F, -level_index);
    // In the order of the voxels, not of the visits: rows of neighbours are read again while they are
    // still in the cache, and the blocks are written as eight streams.
    parallel_for(voxels, 512, [&](std::size_t i) {
        const auto v = static_cast<VoxelIndex>(i);
        NeighborBlock* block = packed.blocks.data() + packed.first[v];
        const std::uint32_t count = packed.count[v], first = n.first[v];
        for (std::uint32_t j = 0; j < count; ++j)
            fill_lane(block[j / 8], j % 8, n.neighbor[first + j], n.offset[first + j], n.offset[n.reverse[first + j]],
                      unit);
        for (std::uint32_t j = count; j % 8 != 0; ++j)
            fill_lane(block[j / 8], j % 8, v, Vec3f::Zero(), Vec3f::Zero(), unit);
    });
    return packed;
}

}  // namespace fretwork
