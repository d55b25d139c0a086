// OFF -> mesh.
#pragma once

#include <string_view>

#include "core/base/run_control.h"
#include "formats/mesh_data.h"

namespace fretwork {

/// Reads text OFF with any of the prefixes ST, C, N in front of the keyword, comments, polygons, and
/// colours of vertices (COFF) or faces (three or four numbers: integers up to 255 or fractions).
/// Indices into a colour table are skipped with a warning. Where both are coloured, faces win.
/// \param source  name for messages
/// \throws InvalidInput  with line, found and expected; also for 4OFF, nOFF and binary OFF.
MeshFile read_off(std::string_view bytes, std::string_view source, const RunControl& run = {});

}  // namespace fretwork
