// Wavefront OBJ -> mesh.
#pragma once

#include <string_view>

#include "core/base/run_control.h"
#include "formats/mesh_data.h"

namespace fretwork {

/// Reads `v` (with colours behind the coordinates where given) and `f` (indices from 1, negative ones
/// from the end, slashes, polygons). `o` and `g` start parts. Texture coordinates, normals, lines,
/// points and materials are skipped; what else is skipped is named in a warning.
/// \param source  name for messages
/// \throws InvalidInput  with line, found and expected.
MeshFile read_obj(std::string_view bytes, std::string_view source, const RunControl& run = {});

}  // namespace fretwork
