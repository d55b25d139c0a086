// PLY -> mesh.
#pragma once

#include <string_view>

#include "core/base/run_control.h"
#include "formats/mesh_data.h"

namespace fretwork {

/// Reads ASCII and binary PLY of either byte order with elements and properties in any order.
/// Used: x, y, z and red, green, blue (8 or 16 bit, or fractions) of `vertex`; vertex_indices (or
/// vertex_index) and red, green, blue of `face`; vertex_indices of `tristrips`. Where both are
/// coloured, faces win; else a triangle shows the mean of its corners.
/// \param source  name for messages
/// \throws InvalidInput  with line (header, ASCII) or byte (binary), found and expected.
MeshFile read_ply(std::string_view bytes, std::string_view source, const RunControl& run = {});

}  // namespace fretwork
