// The wall's surface as triangles: marching tetrahedra with exact roots and sharp features.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/solidify/wall_field.h"
#include "core/solidify/wall_lattice.h"

namespace fretwork {

/// A vertex of the lattice mesh.
struct WallVertex {
    Vec3 position_mm = Vec3::Zero();
    Vec3f normal = Vec3f::Zero();  ///< of the face it lies on, outward; zero on the sides of holes
    std::uint32_t triangle = 0;    ///< of the input, closest
    WallFace face = WallFace::kUpper;
    bool feature = false;  ///< on an edge between faces
    /// Where a feature would lie if it need not stay inside its simplex, less its position. A wall's edge may leave a
    /// lattice cell through a side whose ends are both outside; see sharpen.h.
    Vec3f to_target_mm = Vec3f::Zero();
};

struct WallMesh {
    std::vector<WallVertex> vertices;
    std::vector<Triangle> triangles;
};

/// Each lattice cell is split into the six tetrahedra round its main diagonal (Kuhn). Every lattice edge whose ends
/// differ in sign carries one vertex, at the root of f along the edge. Where the two vertices of a tetrahedron's face
/// lie on different faces of the wall (or on facets that meet at an angle), a third vertex is put where those faces
/// meet within that lattice triangle; where three or more such meet in one tetrahedron, one is put at its corner.
///
/// Every vertex stays inside its own edge, triangle or tetrahedron, and every polygon is a fan inside its
/// tetrahedron, so that the surface is embedded by construction, whatever the values.
///
/// \param clamp  least share of an edge between a vertex and the edge's ends
WallMesh march_tetrahedra(const WallLattice& lattice, const NodeValues& values, const WallField& field, double clamp,
                          const RunControl& run);

}  // namespace fretwork
