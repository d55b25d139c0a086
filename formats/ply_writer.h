// Mesh -> PLY.
#pragma once

#include <string>

#include "formats/mesh_writer_input.h"

namespace fretwork {

/// Binary, little endian. Colours go to the faces, as most programs read them.
/// \throws InvalidInput  see check_mesh_to_write.
std::string write_ply(const MeshToWrite& input);

}  // namespace fretwork
