// Mesh -> OBJ.
#pragma once

#include <string>

#include "formats/mesh_writer_input.h"

namespace fretwork {

/// Text. Colours are named by material where `obj_materials` names the file that describes them
/// (`write_obj_materials`), and left out otherwise.
/// \throws InvalidInput  see check_mesh_to_write.
std::string write_obj(const MeshToWrite& input);

}  // namespace fretwork
