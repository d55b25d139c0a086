// Models and results: files, standard input and output.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "cli/interrupt.h"
#include "core/base/run_control.h"
#include "formats/mesh_file.h"
#include "formats/run_source.h"

namespace fretwork::cli {

inline constexpr std::string_view kStream = "-";
inline constexpr const char* kStreamName = "standard input";  ///< as messages call it

/// Where a model comes from: a path, or `-` with the format named.
struct ModelSource {
    std::string path;
    std::string format;               ///< empty: from the extension
    std::string unit = "millimeter";  ///< of files that name none
    CadMeshing cad = {};              ///< of STEP, IGES and BREP
    std::string name = {};            ///< of what comes from standard input; empty: "standard input"
    bool ignore_required = false;     ///< of a 3MF: read on where an unknown extension is required
};

/// A model as it lies in its file.
struct ModelBytes {
    std::string bytes;
    MeshFormat format = MeshFormat::kStl;
    std::string name;  ///< the path, or what standard input is called
    LengthUnit unit = LengthUnit::kMillimeter;
    std::optional<std::filesystem::path> folder = {};  ///< that the file lies in; none for a stream
    std::vector<std::string> read_beside = {};         ///< other files that the bytes were made from
    std::vector<RunFile> materials = {};               ///< of an OBJ, where they come from elsewhere than its folder
    std::vector<std::string> warnings = {};
    bool ignore_required = false;
};

/// An OpenSCAD file is rendered: its bytes are those of the mesh.
/// \throws InvalidSetting  a format or unit that is not known; `-` without a format. \throws InvalidInput, FileError
ModelBytes read_bytes(const ModelSource& source, const RunControl& run = {});

/// What a result that holds the model calls it: the name of its file without folder, so that the same file gives the
/// same bytes wherever it lies, and without extension.
std::string title_of(const ModelBytes& model);

MeshFile read_model(const ModelSource& source, const RunControl& run = {});
MeshFile read_model(const ModelBytes& model, const CadMeshing& cad, const RunControl& run = {});

/// \throws InvalidSetting  not a unit.
LengthUnit unit_named(const std::string& name);

/// The format of a result from its extension or name. \throws InvalidSetting  `-` without a format.
MeshFormat output_format(const std::string& path, const std::string& format);

/// Formats that are read and written, as help texts name them.
inline constexpr const char* kReadable = "3MF, STL, OBJ, PLY, OFF, AMF, STEP, IGES, BREP or OpenSCAD";
inline constexpr const char* kWritable = "3MF, STL, OBJ, PLY, OFF, AMF or GLB";

/// A mesh in a file's bytes, and the colours of an OBJ that go beside them.
struct MeshBytes {
    std::string bytes;
    std::string materials_path;  ///< empty: none
    std::string materials;
};

/// \param path  where the mesh will go; an OBJ has its colours beside it unless it is a stream
MeshBytes mesh_bytes(const std::string& path, MeshToWrite mesh, MeshFormat format);

/// `--ignore-required` of the commands that read a 3MF and carve nothing.
void add_ignore_required_flag(CLI::App& command, ModelSource& model);

/// What a reader left out or found odd, on standard error.
void print_warnings(const MeshFile& file);

/// Fails before the work is done rather than after it.
/// \throws FileError  `path` is a folder, cannot be written, or is one of the `inputs`.
void check_target(const std::string& path, std::initializer_list<std::string> inputs = {});

/// Puts finished bytes in place: whole or not at all into a file, straight onto a device, a pipe or `-`.
/// \throws FileError, Cancelled
void put(const std::string& path, std::string_view bytes, Interrupt& interrupt);

/// All of standard input. \throws InvalidInput  over 4 GiB
std::string read_stdin();

}  // namespace fretwork::cli
