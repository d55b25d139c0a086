// Mesh -> OFF.
#pragma once

#include <string>

#include "formats/mesh_writer_input.h"

namespace fretwork {

/// Text. Colours go behind the faces as three integers.
/// \throws InvalidInput  see check_mesh_to_write.
std::string write_off(const MeshToWrite& input);

}  // namespace fretwork
