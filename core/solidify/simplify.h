// Fewer triangles, within a geometric tolerance.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/run_control.h"
#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

struct SimplifySettings {
    double tolerance_mm = 0.05;
    std::size_t target_triangles = 0;  ///< 0: as the tolerance allows; else the tolerance is doubled until it is met
    /// A sample's colour differs from the mean of its triangle's corners by no more in any channel; 255: colours do
    /// not matter.
    int color_step = 24;
    double block_mm = 10.0;  ///< side of the cubes that are simplified in parallel
};

/// Collapses edges onto one of their ends, so that every vertex of the result is a vertex of the input. Each vertex
/// that goes stays as a sample with the triangle nearest to it, and no later collapse may leave a sample farther from
/// the mesh than the tolerance. Needs a closed manifold mesh and keeps it one; triangles do not turn over.
/// The result is checked for self-intersections with exact predicates; where triangles meet, the last collapses around
/// them are taken back until nothing meets. At worst that is the mesh as it came.
/// The result does not depend on the number of threads: blocks are fixed cubes, and a vertex goes only if all its
/// neighbours lie in its own block; a second and a third pass with shifted cubes treat the seams.
///
/// \param colors  one per vertex
TriangleMesh simplify(const TriangleMesh& mesh, const std::vector<Rgb8>& colors, const SimplifySettings& settings,
                      const RunControl& run = {});

}  // namespace fretwork
