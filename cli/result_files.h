// A carved result as the bytes of a file.
#pragma once

#include <string>

#include "cli/files.h"
#include "core/base/run_control.h"
#include "core/pipeline/carve.h"
#include "formats/mesh_file.h"

namespace fretwork::cli {

/// 3MF with colours, voxel data, resolved spec and report; the other formats with what they can hold. The same
/// input, settings and seed always give the same bytes.
/// \param path  where it will go
MeshBytes carved_bytes(const CarveResult& result, const Settings& settings, const CarveInput& input,
                       const std::string& path, MeshFormat format, const RunControl& run);

}  // namespace fretwork::cli
