// Which voxels may be updated at the same time (section 4.3 of the paper, after Lefebvre and Hoppe 2005).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Eight sub-passes by the parity of the coordinates: voxels that touch are never in the same one.
/// A sub-pass reads what the earlier ones have committed.
inline constexpr std::size_t kSubpasses = 8;

struct Subpasses {
    std::vector<VoxelIndex> order;  ///< the voxels by sub-pass, ascending within each
    std::array<std::uint32_t, kSubpasses + 1> first{};

    [[nodiscard]] std::span<const VoxelIndex> of(std::size_t subpass) const {
        return {order.data() + first[subpass], order.data() + first[subpass + 1]};
    }
};

/// Sorts the listed voxels (ascending) into sub-passes.
Subpasses split_into_subpasses(const std::vector<VoxelCoord>& coords, std::span<const VoxelIndex> voxels);

}  // namespace fretwork
