// Mesh -> binary STL.
#pragma once

#include <string>

#include "formats/mesh_writer_input.h"

namespace fretwork {

/// Normals are unit vectors of the rounded corners; a triangle without area gets +z, because a
/// stretch of zero bytes makes some readers take the file for text. The header never starts with
/// "solid". Colours are not written.
/// \throws InvalidInput  see check_mesh_to_write.
std::string write_stl(const MeshToWrite& input);

}  // namespace fretwork
