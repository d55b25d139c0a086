// Fewer triangles, within a geometric tolerance.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/solidify/mesh_areas.h"

namespace fretwork {

struct SimplifySettings {
    double tolerance_mm = 0.05;
    std::size_t target_triangles = 0;  ///< 0: as the tolerance allows; else the tolerance is doubled until it is met
    double border_mm = 0.1;            ///< how far the border between two areas may move when a vertex of it goes
    double block_mm = 10.0;            ///< side of the cubes that are simplified in parallel
};

struct SimplifiedMesh {
    TriangleMesh mesh;
    std::vector<std::uint32_t> vertex;    ///< of the input, per vertex
    std::vector<std::uint32_t> triangle;  ///< of the input that each triangle grew from
    bool sound = true;                    ///< no two triangles meet; false only if some of the input met
};

/// Collapses edges onto one of their ends, so that every vertex of the result is a vertex of the input. Each vertex
/// that goes stays as a sample with the triangle nearest to it, and no later collapse may leave a sample farther from
/// the mesh than the tolerance. Needs a closed manifold mesh and keeps it one; triangles do not turn over.
/// The result is checked for self-intersections with exact predicates; where triangles meet, the last collapses around
/// them are taken back until nothing meets. At worst that is the mesh as it came.
/// The result does not depend on the number of threads: blocks are fixed cubes, and a vertex goes only if all its
/// neighbours lie in its own block; a second and a third pass with shifted cubes treat the seams.
///
/// Triangles keep their areas, and borders between areas their course; only when the tolerance has to be doubled for a
/// target are areas disregarded.
///
/// \param areas  of the mesh's triangles and vertices; all the same where there is nothing to keep
SimplifiedMesh simplify(const TriangleMesh& mesh, const MeshAreas& areas, const SimplifySettings& settings,
                        const RunControl& run = {});

}  // namespace fretwork
