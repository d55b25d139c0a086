// STL -> mesh.
#pragma once

#include <string_view>

#include "core/base/run_control.h"
#include "formats/mesh_data.h"

namespace fretwork {

/// Reads binary and ASCII STL. A file is binary when its size is 84 + 50 n bytes for the n it names,
/// whatever its first word; or when it cannot be text. Corners at equal coordinates become one
/// vertex. The normals in the file are not used: the order of the corners says which side is out.
/// Each `solid` of an ASCII file becomes a part.
/// \param source  name for messages
/// \throws InvalidInput  with byte (binary) or line (ASCII).
MeshFile read_stl(std::string_view bytes, std::string_view source, const RunControl& run = {});

}  // namespace fretwork
