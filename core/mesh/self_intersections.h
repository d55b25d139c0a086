// Triangles that pass through each other.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// All pairs (lower, higher) of triangles that meet anywhere but in the vertices and edge they share by index, decided
/// with exact predicates; ascending. Triangles that fold back onto each other over a shared edge are a pair, and so
/// are triangles that merely touch without sharing vertices. Triangles of exactly zero area are left out.
/// Cost  about 5 s for 2 million triangles.
/// \param run  a stop is honoured
std::vector<std::pair<std::uint32_t, std::uint32_t>> find_self_intersections(const TriangleMesh& mesh,
                                                                             const RunControl& run = {});

}  // namespace fretwork
