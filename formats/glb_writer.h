// Mesh -> glTF 2.0 binary (GLB), for viewers and web pages.
#pragma once

#include <string>

#include "formats/mesh_writer_input.h"

namespace fretwork {

/// Positions are kept in millimetres below a node that turns z up into glTF's y up and scales to metres. Colours
/// become linear vertex colours: a vertex on a border between colours appears once for each. Without normals, as
/// viewers then shade every triangle flat, which is what a carved part looks like. Coordinates are floats.
/// The same input gives the same bytes. \throws InvalidInput  see check_mesh_to_write; over 4 GiB.
std::string write_glb(const MeshToWrite& input);

}  // namespace fretwork
