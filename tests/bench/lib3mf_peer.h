// Reading and writing with Debian's lib3mf, to be timed beside ours.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/mesh/triangle_mesh.h"

namespace fretwork::bench {

/// Reads the file as lib3mf does and keeps its model till all triangles are counted.
/// \throws FileError  with lib3mf's own code.
std::uint64_t lib3mf_read(const std::filesystem::path& path);

/// Geometry alone: one object, one build item. \throws FileError
void lib3mf_write(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace fretwork::bench
