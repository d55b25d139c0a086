// Edges that stand out: folds of a CAD part, rims of an open surface.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork {

struct MeshEdge {
    std::uint32_t low = 0, high = 0;  ///< vertices, low < high
    double fold_deg = 0.0;  ///< between the normals of its two triangles: 0 flat, 180 folded back; 0 on a border
};

/// Edges folded by more than `min_angle_deg`, ascending by (low, high). Edges of more than two triangles always count,
/// with their largest fold. Folds towards a triangle without area count as flat. Vertices are told apart by index.
/// \throws InvalidSetting  the angle is not within [0, 180].
/// \throws InvalidInput    an index past the end or a coordinate that is not finite.
std::vector<MeshEdge> sharp_edges(const TriangleMesh& mesh, double min_angle_deg);

/// Edges with exactly one triangle, ascending by (low, high).
/// \throws InvalidInput  as above.
std::vector<MeshEdge> border_edges(const TriangleMesh& mesh);

}  // namespace fretwork
