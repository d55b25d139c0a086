#include "core/pyramid/neighborhoods.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>

#include "core/base/avx2.h"
#include "core/base/parallel.h"
#include "core/pyramid/flat_ways.h"
#include "core/pyramid/neighbor_lists.h"
#include "core/pyramid/ways.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 1024;

BulkVector<SurfaceFrame> frames_of(const PyramidLevel& level) {
    BulkVector<SurfaceFrame> frames(level.size());
    parallel_for(level.size(), 8 * kGrain, [&](std::size_t v) {
        const Vec3f &p = level.positions[v], &n = level.normals[v];
        frames[v] = {{p.x(), p.y(), p.z(), 0.0F}, {n.x(), n.y(), n.z(), 0.0F}};
    });
    return frames;
}

// Fills the blocks of single entries.
class BlockWriter {
  public:
    BlockWriter(const PyramidLevel& level, const Ways& ways, float unit)
        : unfolder_(level, ways),
          frames_(frames_of(level)),
          lay_flat_(machine_has_avx2() ? lay_flat_avx2 : lay_flat_portable),
          unit_(unit) {}

    // \param list  N(v), marked
    void write(VoxelIndex v, std::span<const std::uint32_t> list, NeighborBlock* blocks) const {
        for (std::size_t i = 0; i < list.size(); i += 8) {
            NeighborBlock& block = blocks[i / 8];
            const std::size_t used = std::min<std::size_t>(8, list.size() - i);
            std::uint32_t creased = 0;
            for (std::size_t lane = 0; lane < used; ++lane) {
                block.neighbor[lane] = list[i + lane] & ~kCreased;
                creased |= list[i + lane] >> 31 << lane;
            }
            for (std::size_t lane = used; lane < 8; ++lane) block.neighbor[lane] = v;
            const std::uint32_t bent = lay_flat_(frames_.data(), v, unit_, block);
            for (std::uint32_t left = creased | bent; left != 0; left &= left - 1) {
                const int lane = std::countr_zero(left);
                unfold(v, (creased >> lane & 1u) == 0, static_cast<std::size_t>(lane), block);
            }
        }
    }

  private:
    void unfold(VoxelIndex v, bool smooth_way, std::size_t lane, NeighborBlock& block) const {
        const auto [out, back] = unfolder_.unfold(v, block.neighbor[lane], smooth_way);
        const auto fixed = [this](float coordinate) { return offset_to_fixed(coordinate, unit_); };
        block.out_xy[lane] = pack16(fixed(out.x()), fixed(out.y()));
        block.back_xy[lane] = pack16(fixed(back.x()), fixed(back.y()));
        block.z[lane] = pack16(fixed(out.z()), fixed(back.z()));
    }

    Unfolder unfolder_;
    BulkVector<SurfaceFrame> frames_;
    LayFlat lay_flat_;
    float unit_;
};

}  // namespace

Neighborhoods find_neighborhoods(const PyramidLevel& level, int level_index, const RunControl& run) {
    Neighborhoods result;
    result.first.assign(level.size() + 1, 0);
    if (level.size() == 0) return result;
    const Ways ways(level);
    const NeighborLists lists(level, ways, run);
    result.count.resize(level.size());
    for (std::size_t v = 0; v < level.size(); ++v) {
        const std::uint32_t count = std::min(lists.count(static_cast<VoxelIndex>(v)), Neighborhoods::kMost);
        result.count[v] = static_cast<std::uint16_t>(count);
        result.first[v + 1] = result.first[v] + (count + 7) / 8;
    }
    result.blocks.resize(result.first.back());
    const BlockWriter writer(level, ways, std::ldexp(4096.0F, -level_index));
    parallel_chunks(level.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        lists.list(begin, end, [&](VoxelIndex v, std::span<const std::uint32_t> list) {
            writer.write(v, list.first(result.count[v]), result.blocks.data() + result.first[v]);
        });
    });
    return result;
}

}  // namespace fretwork
