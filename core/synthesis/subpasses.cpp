#include "core/synthesis/subpasses.h"

namespace fretwork {
namespace {

std::size_t subpass_of(const VoxelCoord& c) {
    return static_cast<std::size_t>((c[0] & 1) | (c[1] & 1) << 1 | (c[2] & 1) << 2);
}

}  // namespace

Subpasses split_into_subpasses(const std::vector<VoxelCoord>& coords, std::span<const VoxelIndex> voxels) {
    Subpasses result;
    for (const VoxelIndex v : voxels) ++result.first[subpass_of(coords[v]) + 1];
    for (std::size_t s = 0; s < kSubpasses; ++s) result.first[s + 1] += result.first[s];
    result.order.resize(voxels.size());
    std::array<std::uint32_t, kSubpasses> next{};
    for (std::size_t s = 0; s < kSubpasses; ++s) next[s] = result.first[s];
    for (const VoxelIndex v : voxels) result.order[next[subpass_of(coords[v])]++] = v;
    return result;
}

}  // namespace fretwork
