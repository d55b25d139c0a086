// The mesh of a report's 3D view as JSON with packed buffers.
#pragma once

#include <string>

#include "formats/report_html.h"

namespace fretwork {

/// Box, positions in 16 bits of it, indices in 16 bits where they suffice, three bytes of facts per triangle, three of
/// colour per vertex and the colours of stress; the buffers in base64. Holds no character that would end a script
/// element. \throws InvalidInput  facts that do not match the triangles
std::string report_mesh_json(const ReportMesh& mesh);

}  // namespace fretwork
