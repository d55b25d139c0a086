// 3MF -> mesh.
#pragma once

#include <string_view>

#include "core/base/run_control.h"
#include "formats/mesh_data.h"

namespace fretwork {

/// Reads what the build shows: every item with its components, placed by their transforms, in
/// millimetres; one part per item. Colours of colour groups and base materials; other properties are
/// skipped with a warning. Objects may be defined in any order and in several model parts. A mirroring
/// transform turns its triangles round. Support structures are left out with a warning.
///
/// Guards: those of ZipReader, XmlReader and ModelReader; at most 32 levels of components, no cycles,
/// at most 16384 placed meshes; and placing may not make more than 4 M triangles or twice those stored.
/// \throws InvalidInput  naming part and line; also for an empty build or an item without triangles.
/// \throws Cancelled
MeshFile read_threemf(std::string_view bytes, std::string_view source, const RunControl& run = {});

}  // namespace fretwork
