// Mesh -> Additive Manufacturing File (AMF 1.1), plain XML in millimetres.
#pragma once

#include <string>

#include "formats/mesh_writer_input.h"

namespace fretwork {

/// One object with one volume; colours on triangles. The same input gives the same bytes. \throws InvalidInput
std::string write_amf(const MeshToWrite& input);

}  // namespace fretwork
