// Where the wall's surface crosses a lattice edge.
#pragma once

#include "core/solidify/marching_tets.h"
#include "core/solidify/wall_field.h"

namespace fretwork {

/// One end of a lattice edge.
struct EdgeEnd {
    Vec3 position_mm = Vec3::Zero();
    double phi = 0.0;
    double pattern = 0.0;
    std::uint32_t triangle = 0;
};

/// Root of f between an end inside the wall and one outside. The input surface is met exactly, by intersecting the
/// edge with the mesh; the other faces by regula falsi (Illinois) on the true f, which also closes in on a jump of the
/// pattern at the medial axis.
/// \param clamp  least share of the edge between the vertex and the ends
WallVertex edge_root(const WallField& field, const EdgeEnd& inside, const EdgeEnd& outside, double clamp);

}  // namespace fretwork
