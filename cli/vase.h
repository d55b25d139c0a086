// A model to show patterns on.
#pragma once

#include "core/mesh/triangle_mesh.h"

namespace fretwork::cli {

/// A closed vase, 100 mm high, smooth, with a flat base; about 9000 triangles.
TriangleMesh make_vase();

}  // namespace fretwork::cli
