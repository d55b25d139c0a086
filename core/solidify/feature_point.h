// Where two faces of the wall meet within a lattice triangle, or three within a tetrahedron.
#pragma once

#include <array>
#include <optional>
#include <span>

#include "core/solidify/edge_root.h"
#include "core/solidify/marching_tets.h"
#include "core/solidify/wall_field.h"

namespace fretwork {

/// True if a sharp edge runs between two vertices of one lattice triangle: they lie on different faces of the wall or
/// on facets folded against each other.
[[nodiscard]] bool edge_runs_between(const WallVertex& a, const WallVertex& b);

/// Point of the lattice triangle where the faces of `a` and `b` meet. Empty where they do not meet inside it.
/// \param margin  least barycentric coordinate of the point
std::optional<WallVertex> feature_on_triangle(const WallField& field, const std::array<EdgeEnd, 3>& corner,
                                              const WallVertex& a, const WallVertex& b, double margin);

/// Point of the tetrahedron where the faces of its vertices meet, by least squares over their tangent planes. Empty
/// where that is not on the wall's surface.
std::optional<WallVertex> corner_in_tetrahedron(const WallField& field, const std::array<EdgeEnd, 4>& corner,
                                                std::span<const WallVertex* const> loop, double margin);

}  // namespace fretwork
