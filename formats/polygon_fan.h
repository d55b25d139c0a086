// Polygon -> triangles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// Appends the triangles of one polygon, orientation kept. Three corners are taken as they are;
/// a convex polygon becomes a fan from its first corner, any other one of up to 64 corners is cut ear
/// by ear in the plane of its mean normal. Repeated neighbours are dropped. Corners must be valid indices.
void append_polygon(const std::vector<Vec3>& positions, std::span<const std::uint32_t> corners,
                    std::vector<Triangle>& triangles);

}  // namespace fretwork
