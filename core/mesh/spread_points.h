// Points spread evenly over a surface.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/counter_random.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

double area_mm2(const TriangleMesh& mesh);

struct SpreadPoint {
    Vec3 at_mm = Vec3::Zero();
    std::uint32_t triangle = 0;
};

/// One point in each of `count` strips of equal area, at a random place of it. Triangles without area get none.
/// \param mesh    at least one triangle of some area
/// \param stream  who asks, see counter_random.h
std::vector<SpreadPoint> spread_points(const TriangleMesh& mesh, std::size_t count, std::uint64_t seed,
                                       RandomStream stream);

}  // namespace fretwork
