// What a mesh is and what is wrong with it.
#pragma once

#include <cstddef>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

struct MeshReport {
    std::size_t vertices = 0;
    std::size_t triangles = 0;
    Vec3 min_mm = Vec3::Zero();
    Vec3 max_mm = Vec3::Zero();
    double area_mm2 = 0.0;
    double volume_mm3 = 0.0;                ///< signed; negative means inside out
    std::size_t components = 0;             ///< connected over shared edges
    std::size_t border_edges = 0;           ///< edges with one triangle
    std::size_t non_manifold_edges = 0;     ///< edges with more than two triangles
    std::size_t flipped_edges = 0;          ///< edges whose two triangles run the same way
    std::size_t non_manifold_vertices = 0;  ///< vertices whose triangles form more than one fan
    std::size_t degenerate_triangles = 0;   ///< repeated index or zero area
    std::size_t duplicate_triangles = 0;
    std::size_t self_intersections = 0;  ///< pairs of triangles, counted with exact predicates
    bool self_intersections_counted = false;

    /// Every edge in exactly two triangles that run opposite ways.
    [[nodiscard]] bool closed_manifold() const {
        return triangles > 0 && border_edges == 0 && non_manifold_edges == 0 && flipped_edges == 0;
    }
};

enum class CountSelfIntersections { kNo, kYes };

/// Vertices are told apart by index: weld a soup first (`repair.h`).
/// Cost: linear, plus the box-tree query for self-intersections (about 5 s for 2 M triangles).
/// \throws InvalidInput  no triangle, an index past the end or a coordinate that is not finite.
MeshReport report_mesh(const TriangleMesh& mesh, CountSelfIntersections count = CountSelfIntersections::kNo,
                       const RunControl& run = {});

}  // namespace fretwork
