// 3MF -> mesh.
#pragma once

#include <map>
#include <string_view>

#include "core/base/run_control.h"
#include "formats/mesh_data.h"
#include "formats/mesh_writer_input.h"
#include "formats/threemf_build.h"

namespace fretwork {

/// Reads what the build shows: every item with its components, placed by their transforms, in
/// millimetres; one part per item. Colours of colour groups and base materials; other properties are
/// skipped with a warning. Objects may be defined in any order and in several model parts. A mirroring
/// transform turns its triangles round. Support structures are left out with a warning.
///
/// Guards: those of ZipReader, XmlReader, ModelReader and Build.
/// \throws InvalidInput  naming part and line; also for an empty build or an item without triangles.
/// \throws Cancelled
MeshFile read_threemf(std::string_view bytes, std::string_view source, const RunControl& run = {},
                      const ThreemfReadOptions& options = {});

/// The same with other meshes, in millimetres, in the place of those of some objects.
MeshFile read_threemf_with(std::string_view bytes, std::string_view source,
                           const std::map<threemf::ObjectKey, MeshToWrite>& replaced, const RunControl& run = {},
                           const ThreemfReadOptions& options = {});

/// The same of a build that has been read; its meshes are handed over where they are shown once.
MeshFile flatten_build(threemf::Build build, const std::map<threemf::ObjectKey, MeshToWrite>& replaced,
                       const RunControl& run = {});

}  // namespace fretwork
