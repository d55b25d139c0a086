// Mesh -> OBJ.
#pragma once

#include <string>

#include "formats/mesh_writer_input.h"

namespace fretwork {

/// Text. Colours are not written: OBJ has none that belong to triangles without a second file.
/// \throws InvalidInput  see check_mesh_to_write.
std::string write_obj(const MeshToWrite& input);

}  // namespace fretwork
