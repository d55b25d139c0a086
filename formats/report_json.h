// The run report as JSON; docs/report.schema.json describes it.
#pragma once

#include <string>

#include "core/mesh/mesh_report.h"
#include "core/pipeline/run_report.h"

namespace fretwork {

/// One object, keys in the order of the schema, two blanks per level, a line break at the end.
std::string report_json(const RunReport& report);

/// What `info --json` says about a mesh.
std::string mesh_report_json(const MeshReport& report);

}  // namespace fretwork
