// What a slicer has left out: parts of layers that no printed line runs through.
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/printability/printability.h"

namespace fretwork {

/// Where a printer lays material in one layer, in the coordinates of the bed.
struct PrintedLayer {
    double top_mm = 0.0;          ///< above the bed
    double height_mm = 0.0;       ///< its thickness
    std::vector<Vec2> points_mm;  ///< along the lines, at most about a line's width apart
};

struct LostParts {
    bool compared = false;  ///< false: what is printed is not this mesh as it stands, but turned, copied or arranged
    /// One for each part lost, in the mesh's coordinates; size is the root of the area.
    std::vector<PrintPlace> places;
};

/// The mesh is shifted so that its box lies where the lines do. Parts narrower than one and a half lines are not asked
/// for.
/// \param layers   upwards from the bed
/// \param line_mm  width of a printed line, above 0
LostParts find_lost_parts(const TriangleMesh& mesh, const std::vector<PrintedLayer>& layers, double line_mm,
                          const RunControl& run = {});

}  // namespace fretwork
