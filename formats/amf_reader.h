// Additive Manufacturing File (AMF) -> mesh.
#pragma once

#include <string_view>

#include "core/base/run_control.h"
#include "formats/mesh_data.h"

namespace fretwork {

/// Reads AMF 1.x, plain or packed as the only part of a ZIP: objects, volumes (each a part), constellations with
/// their moves and turns, units, and colours of triangles, vertices, volumes, objects and materials, the first of
/// these that is given. Without a constellation every object stands once where it is.
/// Curved triangles are taken as flat, colours given as formulas and textures are left out; each with a warning.
/// \param source  name for messages
/// \throws InvalidInput  with line, found and expected; also constellations that hold each other, over 8 levels or
///                       over 16384 placed instances.
MeshFile read_amf(std::string_view bytes, std::string_view source, const RunControl& run = {});

}  // namespace fretwork
