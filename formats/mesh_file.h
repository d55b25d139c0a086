// Mesh files of any readable format, by extension or by name of the format.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/run_control.h"
#include "formats/cad_meshing.h"
#include "formats/mesh_data.h"
#include "formats/mesh_writer_input.h"

namespace fretwork {

/// STEP, IGES and BREP can be read only, and only by builds with FRETWORK_STEP; GLB can be written only.
enum class MeshFormat { kStl, kObj, kPly, kOff, kThreemf, kAmf, kGlb, kStep, kIges, kBrep };

/// "stl", "obj", "ply", "off", "3mf", "amf", "glb", "step" or "stp", "iges" or "igs", "brep" or "brp"; case and a
/// leading dot do not matter.
/// \throws InvalidSetting  naming the known ones.
MeshFormat mesh_format_from_name(std::string_view name);

/// "stl", "3mf", "step" ...
std::string_view mesh_format_name(MeshFormat format);

/// \throws InvalidSetting  no or an unknown extension.
MeshFormat mesh_format_from_path(const std::filesystem::path& path);

struct MeshReadOptions {
    std::optional<MeshFormat> format = {};      ///< empty: from the extension
    LengthUnit unit = LengthUnit::kMillimeter;  ///< of formats that name none (STL, OBJ, PLY, OFF, BREP)
    CadMeshing cad = {};                        ///< how finely STEP, IGES and BREP are broken into triangles
    /// Where the materials of an OBJ lie; empty: they are not read. Reading by path sets it.
    std::optional<std::filesystem::path> folder = {};
    /// Those that are at hand already, by the name of their file; they win over the folder.
    std::map<std::string, std::string, std::less<>> materials = {};
    bool ignore_required = false;  ///< of a 3MF: an unknown extension that it requires is a warning
};

/// Limits: files up to 4 GiB, coordinates up to 1e9 in size.
/// \throws InvalidInput    naming file, place, found and expected; also for a file without triangles.
/// \throws InvalidSetting  unknown extension and no format given; a format this build does not read.
/// \throws FileError       cannot be opened.
MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options = {}, const RunControl& run = {});

/// The same from memory; `options.format` is not looked at.
/// \param source  name for messages, such as "standard input"
MeshFile read_mesh(std::string_view bytes, MeshFormat format, std::string_view source,
                   const MeshReadOptions& options = {}, const RunControl& run = {});

/// The bytes of the file; the same input always gives the same bytes.
/// \throws InvalidInput  see check_mesh_to_write. \throws InvalidSetting  a format that is only read.
std::string write_mesh(const MeshToWrite& input, MeshFormat format);

/// The file that holds the colours of an OBJ at `path`: beside it, with the extension mtl and without blanks.
std::filesystem::path obj_materials_path(const std::filesystem::path& path);

/// Whole or not at all (`atomic_write.h`). The materials of a coloured OBJ go into a file beside it.
/// \throws FileError, InvalidInput
void write_mesh(const std::filesystem::path& path, const MeshToWrite& input,
                std::optional<MeshFormat> format = std::nullopt);

}  // namespace fretwork
