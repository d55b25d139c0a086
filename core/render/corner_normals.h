// Normals that make fine facets look smooth and keep sharp edges sharp.
#pragma once

#include <array>
#include <vector>

#include "core/base/vec.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// One unit normal per corner of each triangle: the mean of the normals of those triangles at the same place that
/// differ from this triangle's by less than `crease_angle_deg`, weighted by their angles there. Vertices at equal
/// positions count as one, so triangle soups look smooth too. A triangle without area gets the normal +z.
std::vector<std::array<Vec3f, 3>> corner_normals(const TriangleMesh& mesh, double crease_angle_deg);

}  // namespace fretwork
