#include "core/synthesis/neighbor_blocks.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "core/synthesis/texel_map.h"

namespace fretwork {
namespace {

LevelOffset pack_offset(const Vec3f& offset, float cells_per_voxel) {
    const auto convert = [&](float x) {
        return static_cast<std::int32_t>(std::lrint(std::clamp(x * cells_per_voxel * 4096.0F, -32767.0F, 32767.0F)));
    };
    return {pack16(convert(offset.x()), convert(offset.y())), pack16(convert(offset.z()), 0)};
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

    const float cells_per_voxel = std::ldexp(1.0F, -level_index);
    parallel_for(voxels, 512, [&](std::size_t i) {
        const VoxelIndex v = subpasses.order[i];
        NeighborBlock* block = packed.blocks.data() + packed.first[v];
        for (std::uint32_t j = 0; j < (packed.count[v] + 7u) / 8u * 8u; ++j) {
            NeighborBlock& b = block[j / 8];
            const std::uint32_t lane = j % 8;
            if (j < packed.count[v]) {
                const std::uint32_t pair = n.first[v] + j;
                const LevelOffset out = pack_offset(n.offset[pair], cells_per_voxel);
                const LevelOffset back = pack_offset(n.offset[n.reverse[pair]], cells_per_voxel);
                b.out_xy[lane] = out.xy, b.out_z[lane] = out.z;
                b.back_xy[lane] = back.xy, b.back_z[lane] = back.z;
                b.neighbor[lane] = n.neighbor[pair];
            } else {
                b.out_xy[lane] = b.out_z[lane] = b.back_xy[lane] = b.back_z[lane] = 0;
                b.neighbor[lane] = v;
            }
        }
    });
    return packed;
}

}  // namespace fretwork
