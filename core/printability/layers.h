// A mesh cut into layers. Internal to this folder and its tests.
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/printability/polygons.h"

namespace fretwork {

struct Layer {
    double middle_mm = 0.0;  ///< height of the cut
    Polygons outline;        ///< what is solid; outer borders counter-clockwise, holes clockwise
};

/// What is solid at each of the heights, which ascend. Overlapping pieces are one. Deterministic.
std::vector<Layer> cut_at(const TriangleMesh& mesh, const std::vector<double>& heights_mm, const RunControl& run);

/// Layer i reaches from `bottom + i h` to `bottom + (i + 1) h`, where `bottom` is the lowest vertex, and is cut at its
/// middle.
std::vector<Layer> cut_layers(const TriangleMesh& mesh, double layer_height_mm, const RunControl& run);

}  // namespace fretwork
