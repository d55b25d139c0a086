// Connected pieces of a triangle mesh.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/edge_table.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

enum class ConnectedBy {
    kEdge,    ///< triangles that share an edge
    kVertex,  ///< triangles that share a vertex
};

struct MeshComponents {
    std::vector<std::uint32_t> of_triangle;  ///< component of each triangle, numbered by lowest triangle
    std::uint32_t count = 0;
};

/// Vertices are told apart by index: weld a soup first. Cost linear.
/// \throws InvalidInput  an index past the end.
/// \throws Cancelled     `run` asked to stop.
MeshComponents find_components(const TriangleMesh& mesh, ConnectedBy by = ConnectedBy::kEdge,
                               const RunControl& run = {});

/// Over shared edges, where these are known.
MeshComponents find_components(const TriangleMesh& mesh, const EdgeTable& edges);

struct ComponentMesh {
    TriangleMesh mesh;
    std::vector<std::uint32_t> source_triangles;  ///< triangle of the whole mesh, ascending
};

/// One mesh per component, with the vertices it uses, in their old order. A vertex that two components use is copied.
std::vector<ComponentMesh> split_components(const TriangleMesh& mesh, const MeshComponents& components);

}  // namespace fretwork
