// Connected pieces of lattice nodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/solidify/wall_lattice.h"

namespace fretwork {

struct LatticePieces {
    static constexpr std::uint32_t kNone = ~std::uint32_t{0};

    std::vector<std::uint32_t> of_node;  ///< kNone for nodes that were not asked for
    std::vector<std::size_t> nodes;      ///< per piece
    std::vector<std::uint8_t> at_end;    ///< per piece: an edge of one of its nodes leads out of the lattice

    [[nodiscard]] std::size_t count() const { return nodes.size(); }
};

/// Pieces of the nodes with `wanted` not zero, joined by the edges of the lattice's tetrahedra; numbered by their first
/// node. Blocks are flooded in parallel and joined over their sides.
LatticePieces find_pieces(const WallLattice& lattice, const std::vector<std::uint8_t>& wanted, const RunControl& run);

}  // namespace fretwork
