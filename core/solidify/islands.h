// One solid piece per connected component of the input.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/solidify/wall_lattice.h"

namespace fretwork {

struct RemovedIslands {
    std::size_t count = 0;
    double volume_mm3 = 0.0;  ///< one lattice cell per node
};

/// Keeps, for each component of the input, the largest piece of wall around it, and turns the nodes of the others
/// empty. Pieces are told apart by solid, not by surface, so that hollows stay.
/// \param triangle_component  per triangle of the input
RemovedIslands remove_islands(const WallLattice& lattice, const WallField& field,
                              const std::vector<std::uint32_t>& triangle_component, NodeValues& values,
                              const RunControl& run);

/// Connected component of each triangle over shared vertices, numbered by first triangle.
std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh);

}  // namespace fretwork
