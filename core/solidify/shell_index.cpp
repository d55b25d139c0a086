#include "core/solidify/shell_index.h"

#include <cmath>
#include <limits>

namespace fretwork {
namespace {

constexpr std::int32_t kBlockBits = 3;
constexpr std::int32_t kBlockMask = (1 << kBlockBits) - 1;
constexpr std::size_t kBlockCells = 512;

/// For the rounding of positions, in voxels.
constexpr double kSlack = 1e-3;

bool same_cell(const VoxelCoord& a, const VoxelCoord& b) {
    return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

std::size_t cell_in_block(const VoxelCoord& c) {
    const auto cell =
        ((c[2] & kBlockMask) << (2 * kBlockBits)) + ((c[1] & kBlockMask) << kBlockBits) + (c[0] & kBlockMask);
    return static_cast<std::size_t>(cell);
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
    const auto look_into = [&](const VoxelCoord& c) {
        const VoxelIndex first = first_in_cell(c);
        if (first == kNone) return;
        for (VoxelIndex v = first; v < shell_->size() && same_cell(shell_->coords[v], c); ++v) {
            const double facing = static_cast<double>(shell_->normals[v].dot(normal));
            // A sheet that faces away is taken only where there is no other: at the rim of a thin plate.
            const double score = (shell_->points_mm[v] - point_mm).norm() / grid.voxel_mm + (facing < 0.0 ? 4.0 : 0.0);
            if (score < best_score || (score == best_score && v < best)) {
                best_score = score;
                best = v;
            }
        }
    };
    look_into(at);
    // A voxel's point lies in its cell: cells farther than the best so far hold nothing better.
    for (std::int32_t dz = -1; dz <= 1; ++dz)
        for (std::int32_t dy = -1; dy <= 1; ++dy)
            for (std::int32_t dx = -1; dx <= 1; ++dx) {
                const VoxelCoord way = {dx, dy, dz};
                double gap2 = 0.0;
                for (std::size_t k = 0; k < 3; ++k) {
                    const double share = q[static_cast<Eigen::Index>(k)] - at[k];
                    const double gap = way[k] == 0 ? 0.0 : way[k] < 0 ? share : 1.0 - share;
                    gap2 += gap * gap;
                }
                if (dx == 0 && dy == 0 && dz == 0) continue;
                if (best != kNone && gap2 > (best_score + kSlack) * (best_score + kSlack)) continue;
                look_into({at[0] + dx, at[1] + dy, at[2] + dz});
            }
    return best;
}

}  // namespace fretwork
