// One solid piece per connected component of the input, without trapped hollows.
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

/// Fills the hollows that no opening reaches and that hold less than a fiftieth of the wall, as two walls that nearly
/// meet leave between them: powder, resin or support would stay in them for ever, and slicers count each as a part.
/// Larger closed hollows are what was asked for and stay.
/// \return how many were filled
std::size_t fill_trapped_hollows(const WallLattice& lattice, const WallField& field, NodeValues& values,
                                 const RunControl& run);

/// Connected component of each triangle over shared vertices, numbered by first triangle.
std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh);

}  // namespace fretwork
