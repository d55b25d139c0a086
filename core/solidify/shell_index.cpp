#include "core/solidify/shell_index.h"

#include <cmath>
#include <limits>

namespace fretwork {
namespace {

constexpr std::int32_t kBlockBits = 3;
constexpr std::int32_t kBlockMask = (1 << kBlockBits) - 1;
constexpr std::size_t kBlockCells = 512;

std::size_t cell_in_block(const VoxelCoord& c) {
    return static_cast<std::size_t>(((c[2] & kBlockMask) << (2 * kBlockBits)) + ((c[1] & kBlockMask) << kBlockBits) +
                                    (c[0] & kBlockMask));
}

}  // namespace

ShellIndex::ShellIndex(const SurfaceVoxels& shell) : shell_(&shell) {
    for (std::size_t k = 0; k < 3; ++k) block_extent_[k] = (shell.grid.extent[k] >> kBlockBits) + 1;
    block_.assign(static_cast<std::size_t>(block_extent_[0]) * static_cast<std::size_t>(block_extent_[1]) *
                      static_cast<std::size_t>(block_extent_[2]),
                  kNone);
    for (VoxelIndex v = static_cast<VoxelIndex>(shell.size()); v-- > 0;) {
        const VoxelCoord& c = shell.coords[v];
        const std::size_t b =
            (static_cast<std::size_t>(c[2] >> kBlockBits) * static_cast<std::size_t>(block_extent_[1]) +
             static_cast<std::size_t>(c[1] >> kBlockBits)) *
                static_cast<std::size_t>(block_extent_[0]) +
            static_cast<std::size_t>(c[0] >> kBlockBits);
        if (block_[b] == kNone) {
            block_[b] = static_cast<std::uint32_t>(cell_.size() / kBlockCells);
            cell_.resize(cell_.size() + kBlockCells, kNone);
        }
        cell_[block_[b] * kBlockCells + cell_in_block(c)] = v;
    }
}

VoxelIndex ShellIndex::first_in_cell(const VoxelCoord& c) const {
    for (std::size_t k = 0; k < 3; ++k)
        if (c[k] < 0 || (c[k] >> kBlockBits) >= block_extent_[k]) return kNone;
    const std::size_t b = (static_cast<std::size_t>(c[2] >> kBlockBits) * static_cast<std::size_t>(block_extent_[1]) +
                           static_cast<std::size_t>(c[1] >> kBlockBits)) *
                              static_cast<std::size_t>(block_extent_[0]) +
                          static_cast<std::size_t>(c[0] >> kBlockBits);
    return block_[b] == kNone ? kNone : cell_[block_[b] * kBlockCells + cell_in_block(c)];
}

VoxelIndex ShellIndex::nearest(const Vec3& point_mm, const Vec3f& normal) const {
    const VoxelGrid& grid = shell_->grid;
    const Vec3 q = (point_mm - grid.origin_mm) / grid.voxel_mm;
    const VoxelCoord at = {static_cast<std::int32_t>(std::floor(q[0])), static_cast<std::int32_t>(std::floor(q[1])),
                           static_cast<std::int32_t>(std::floor(q[2]))};
    VoxelIndex best = kNone;
    double best_score = std::numeric_limits<double>::infinity();
    for (std::int32_t z = at[2] - 1; z <= at[2] + 1; ++z)
        for (std::int32_t y = at[1] - 1; y <= at[1] + 1; ++y)
            for (std::int32_t x = at[0] - 1; x <= at[0] + 1; ++x) {
                const VoxelCoord c = {x, y, z};
                for (VoxelIndex v = first_in_cell(c); v < shell_->size() && shell_->coords[v] == c; ++v) {
                    const double facing = static_cast<double>(shell_->normals[v].dot(normal));
                    // A sheet that faces away is taken only where there is no other: at the rim of a thin plate.
                    const double score =
                        (shell_->points_mm[v] - point_mm).norm() / grid.voxel_mm + (facing < 0.0 ? 4.0 : 0.0);
                    if (score < best_score) {
                        best_score = score;
                        best = v;
                    }
                }
            }
    return best;
}

}  // namespace fretwork
