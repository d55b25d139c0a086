// The triangle mesh that enters the flow and leaves it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/vec.h"

namespace fretwork {

/// Vertex indices, counter-clockwise seen from outside.
using Triangle = std::array<std::uint32_t, 3>;

/// An indexed triangle set. Nothing is promised about closedness or manifoldness; `mesh_report.h`
/// tells and `repair.h` mends.
struct TriangleMesh {
    std::vector<Vec3> positions_mm;
    std::vector<Triangle> triangles;
};

}  // namespace fretwork
