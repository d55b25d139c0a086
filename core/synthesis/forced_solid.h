// The constraint of section 4.4 of the paper on one level.
#pragma once

#include <cstdint>
#include <vector>

#include "core/synthesis/texel_map.h"

namespace fretwork {

/// A forced voxel may only take labels that show solid at its probe: its own surface point on the
/// finest level, on coarser ones the forced point below it that lies closest to the middle of all.
struct ForcedSolid {
    std::vector<std::uint32_t>
        entry;  ///< per voxel of the level: position in `probes` plus one, 0 where free; empty: all free
    std::vector<FixedPoint> probes;

    /// Null where the voxel is free.
    [[nodiscard]] const FixedPoint* probe(std::size_t v) const {
        return entry.empty() || entry[v] == 0 ? nullptr : &probes[entry[v] - 1];
    }
};

}  // namespace fretwork
