// Wavefront OBJ -> mesh.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "core/base/run_control.h"
#include "formats/mesh_data.h"

namespace fretwork {

/// The bytes of a material library by the name an OBJ gives it; nothing where it cannot be found.
using ObjMaterialFiles = std::function<std::optional<std::string>(std::string_view name)>;

/// Reads `v` (with colours behind the coordinates where given) and `f` (indices from 1, negative ones
/// from the end, slashes, polygons). `o` and `g` start parts. Triangles have the diffuse colour of their
/// material, else the mean of their corners'. Texture coordinates, normals, lines and points are skipped; what else
/// is skipped is named in a warning.
/// \param source     name for messages
/// \param materials  where the libraries come from; empty: colours of materials are left out, with a warning
/// \throws InvalidInput  with line, found and expected.
MeshFile read_obj(std::string_view bytes, std::string_view source, const ObjMaterialFiles& materials = {},
                  const RunControl& run = {});

}  // namespace fretwork
