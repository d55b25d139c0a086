// The one place that says which meshes can be worked on at all.
#pragma once

#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// Whether surfaces without area are let through (`repair_mesh` and reports look at them).
enum class ZeroArea { kAllowed, kRefused };

/// \param caller  starts the message, as in "repair: the mesh has no triangles".
/// \throws InvalidInput  no triangle; more than 2^32 / 3 - 2 vertices or triangles; an index past the end; a coordinate
///                       that is not finite or beyond 1e9 mm (a thousand kilometres: surely a fault, and squares of it
///                       would lose the small lengths); on request a surface of zero area. Names the place.
void check_mesh(const TriangleMesh& mesh, const char* caller, ZeroArea zero_area = ZeroArea::kRefused);

}  // namespace fretwork
