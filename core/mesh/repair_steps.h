// The steps of repair_mesh, in their order. Internal to this folder.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/mesh/edge_table.h"
#include "core/mesh/repair.h"

namespace fretwork::repair {

inline constexpr HalfEdge kNoMate = std::numeric_limits<HalfEdge>::max();

/// The surface under repair.
struct Draft {
    TriangleMesh mesh;
    std::vector<std::uint32_t> source;  ///< triangle of the input
    RepairCounts counts;
    RunControl run;
};

/// Items between two looks at the stop request.
inline constexpr std::uint32_t kOften = 1u << 16;

/// Vertices of one position become one; those without a triangle go.
void weld_equal_positions(Draft& draft);

/// Border vertices within `reach_mm` of each other become one.
void weld_borders(Draft& draft, double reach_mm);

/// Triangles without width go. Where one lay between two neighbours, the neighbour along its longest side is split at
/// its middle corner, so that the surface stays whole.
void drop_degenerate(Draft& draft);

/// One copy of each triangle stays. Where both sides of a wall inside the material are given, both go.
void drop_duplicates(Draft& draft);

/// Turns triangles so that neighbours over two-triangle edges agree; each patch keeps the turn of most of its area.
void agree_on_turn(Draft& draft);

/// For every half-edge the one that it is glued to, or kNoMate. Mates run opposite ways. Edges of more than two
/// triangles are taken apart wedge by wedge.
std::vector<HalfEdge> glue_half_edges(Draft& draft);

/// Gives each fan of glued triangles its own vertex, and each glued pair its own edge.
void separate_sheets(Draft& draft, std::vector<HalfEdge> mates);

/// Turns closed pieces outward; see repair.h for nested ones. Then counts the pieces and what is open.
/// \param edges  of the mesh as it is; turning a triangle changes which of its half-edges is which, but not the edges
void turn_outward(Draft& draft, const EdgeTable& edges);

/// Renumbers vertices: `target[v]` is the vertex that v becomes; unnamed ones go.
void remap_vertices(Draft& draft, const std::vector<std::uint32_t>& target);

/// Keeps the triangles that are not marked, and the vertices that these name.
void drop_triangles(Draft& draft, const std::vector<std::uint8_t>& drop);

}  // namespace fretwork::repair
