// Stage 0: whatever a file holds -> a manifold surface with one orientation per piece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

struct RepairSettings {
    /// Vertices on open borders that are closer than this become one, which closes the cracks of rounded files.
    /// Range >= 0; 0 stands for a millionth of the longest side.
    double weld_mm = 0.0;
};

/// What was done, for warnings. All zero for a clean mesh.
struct RepairCounts {
    std::size_t welded_vertices = 0;       ///< same position as an earlier vertex
    std::size_t border_welds = 0;          ///< moved onto a border vertex within `weld_mm`
    std::size_t unused_vertices = 0;       ///< named by no triangle
    std::size_t degenerate_triangles = 0;  ///< of no width; neighbours were split where that was needed
    std::size_t duplicate_triangles = 0;   ///< further copies of a triangle
    std::size_t inner_wall_triangles =
        0;                             ///< both sides of walls inside the material, where two solids were put together
    std::size_t turned_triangles = 0;  ///< against their neighbours
    std::size_t non_manifold_edges = 0;   ///< with more than two triangles, taken apart
    std::size_t one_sided_edges = 0;      ///< cut because the surface cannot be oriented across them (Moebius)
    std::size_t split_vertices = 0;       ///< copies made where sheets touch
    std::size_t inverted_components = 0;  ///< closed pieces that were inside out

    // What is left.
    std::size_t components = 0;
    std::size_t open_components = 0;
    std::size_t border_edges = 0;

    bool operator==(const RepairCounts&) const = default;
};

struct RepairedMesh {
    TriangleMesh mesh;
    std::vector<std::uint32_t> source_triangles;  ///< triangle of the input that each triangle is (part of)
    RepairCounts counts;
};

/// Makes the surface fit for the flow without changing its shape: no degenerate or duplicate triangle, every edge in
/// one or two triangles that run opposite ways, one fan per vertex, every closed piece outward. What is closed stays
/// closed, what is open stays open; holes are not filled and self-intersections stay (`mesh_report.h` counts them).
///
/// Where more than two triangles meet in an edge, those that bound the same wedge of material belong together; the
/// solids on both sides then touch without sharing vertices. Copies of a vertex keep its exact position. A piece inside
/// another keeps its turn relative to the outermost one: the hollow of a ball stays a hollow, and if the ball was
/// inside out, both are turned. An open piece gets the turn that most of its area had.
///
/// Order  vertices and triangles keep theirs; copies come last. The same input gives the same result on every run.
/// Cost   about 1 s per million triangles.
/// \throws InvalidInput    no triangle; an index past the end; a coordinate that is not finite or beyond 1e9 mm; a
///                         surface without area.
/// \throws InvalidSetting  `weld_mm` negative or not finite.
/// \throws Cancelled       `run` asked to stop.
RepairedMesh repair_mesh(const TriangleMesh& mesh, const RepairSettings& settings = {}, const RunControl& run = {});

/// One sentence per kind of repair that was needed, with its count: "12 duplicate triangles were dropped".
std::vector<std::string> describe(const RepairCounts& counts);

}  // namespace fretwork
