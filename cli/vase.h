// A model to show patterns on.
#pragma once

#include "core/mesh/region.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork::cli {

/// A vase, 100 mm high, smooth, with a flat base and open at the top; about 9000 triangles.
TriangleMesh make_vase();

/// Its upper rim, which looks better whole.
Region vase_lip();

}  // namespace fretwork::cli
