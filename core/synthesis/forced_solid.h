// The constraint of section 4.4 of the paper on one level.
#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/texel_map.h"

namespace fretwork {

/// A forced voxel may only take labels that show solid at its probe: its own surface point on the
/// finest level, on coarser ones the forced point below it that lies closest to the middle of all.
struct ForcedSolid {
    std::vector<std::uint8_t> forced;  ///< one byte per voxel of the level; empty: none
    std::vector<FixedPoint> probe;     ///< where forced

    [[nodiscard]] bool holds(std::size_t v) const { return !forced.empty() && forced[v] != 0; }
};

}  // namespace fretwork
