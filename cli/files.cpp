#include "cli/files.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include "cli/scad_model.h"
#include "core/base/error.h"
#include "formats/atomic_write.h"
#include "formats/obj_materials.h"
#include "formats/read_file.h"

namespace fretwork::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail_write(const std::string& path, int code) {
    throw FileError(
        fmt::format("{}: cannot be written: {}", path == kStream ? "standard output" : path, std::strerror(code)));
}

void write_all(int descriptor, std::string_view bytes, const std::string& path) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) fail_write(path, errno);
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
}

// A device or a pipe cannot be replaced by renaming: /dev/full must stay what it is.
bool is_special(const std::string& path) {
    std::error_code none;
    const fs::file_status status = fs::status(path, none);
    return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

void write_special(const std::string& path, std::string_view bytes) {
    const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
    if (descriptor < 0) fail_write(path, errno);
    try {
        write_all(descriptor, bytes, path);
    } catch (...) {
        ::close(descriptor);
        throw;
    }
    if (::close(descriptor) != 0) fail_write(path, errno);
}

struct Commit {
    explicit Commit(Interrupt& i) : interrupt(i) { interrupt.begin_commit(); }
    ~Commit() { interrupt.end_commit(); }
    Commit(const Commit&) = delete;
    Commit& operator=(const Commit&) = delete;
    Interrupt& interrupt;
};

}  // namespace

std::string read_stdin() {
    std::string bytes;
    std::array<char, 1 << 16> block{};
    while (true) {
        const ssize_t count = ::read(STDIN_FILENO, block.data(), block.size());
        if (count < 0 && errno == EINTR) continue;
        if (count < 0) throw FileError(fmt::format("standard input: cannot be read: {}", std::strerror(errno)));
        if (count == 0) return bytes;
        bytes.append(block.data(), static_cast<std::size_t>(count));
        if (bytes.size() > kMaxFileBytes) throw InvalidInput("standard input: over 4 GiB");
    }
}

LengthUnit unit_named(const std::string& name) {
    if (const auto unit = length_unit_from_name(name)) return *unit;
    throw InvalidSetting(
        fmt::format("--input-unit {}: expected micron, millimeter, centimeter, meter, inch or foot", name));
}

ModelBytes read_bytes(const ModelSource& source, const RunControl& run) {
    if (is_scad(source)) return render_scad(source.path, {}, ScadMarks::kLeaveOut, run).model;
    ModelBytes model;
    model.unit = unit_named(source.unit);
    model.ignore_required = source.ignore_required;
    const bool stream = source.path == kStream;
    if (stream && source.format.empty()) throw InvalidSetting("reading from standard input needs --input-format");
    if (!stream && !source.name.empty()) throw InvalidSetting("--input-name goes with - for standard input");
    model.format = source.format.empty() ? mesh_format_from_path(source.path) : mesh_format_from_name(source.format);
    model.name = !stream ? source.path : source.name.empty() ? kStreamName : source.name;
    model.bytes = stream ? read_stdin() : read_file(fs::path(source.path));
    if (!stream) model.folder = fs::path(source.path).parent_path();
    return model;
}

std::string title_of(const ModelBytes& model) {
    return fs::path(model.name).stem().string();
}

MeshFile read_model(const ModelSource& source, const RunControl& run) {
    return read_model(read_bytes(source, run), source.cad, run);
}

MeshFile read_model(const ModelBytes& model, const CadMeshing& cad, const RunControl& run) {
    MeshReadOptions options;
    options.unit = model.unit;
    options.cad = cad;
    options.folder = model.folder;
    options.ignore_required = model.ignore_required;
    for (const RunFile& file : model.materials) options.materials.emplace(file.path, file.bytes);
    MeshFile file = read_mesh(model.bytes, model.format, model.name, options, run);
    file.warnings.insert(file.warnings.begin(), model.warnings.begin(), model.warnings.end());
    for (const std::string& beside : model.read_beside) file.read_beside.push_back({beside, {}});
    return file;
}

void add_ignore_required_flag(CLI::App& command, ModelSource& model) {
    command.add_flag("--ignore-required", model.ignore_required,
                     "Read a 3MF although it requires an extension that is not known");
}

void print_warnings(const MeshFile& file) {
    for (const std::string& warning : file.warnings) fmt::print(stderr, "fretwork: warning: {}\n", warning);
}

MeshBytes mesh_bytes(const std::string& path, MeshToWrite mesh, MeshFormat format) {
    MeshBytes out;
    if (format != MeshFormat::kObj || mesh.triangle_colors.empty() || path == kStream || is_special(path)) {
        out.bytes = write_mesh(mesh, format);
        return out;
    }
    const fs::path materials = obj_materials_path(path);
    const std::string name = materials.filename().string();
    mesh.obj_materials = name;
    out.bytes = write_mesh(mesh, format);
    out.materials_path = materials.string();
    out.materials = write_obj_materials(mesh.triangle_colors);
    return out;
}

MeshFormat output_format(const std::string& path, const std::string& format) {
    if (!format.empty()) return mesh_format_from_name(format);
    if (path == kStream) throw InvalidSetting("writing to standard output needs --export-format");
    return mesh_format_from_path(path);
}

void check_target(const std::string& path, std::initializer_list<std::string> inputs) {
    if (path.empty() || path == kStream) return;
    for (const std::string& input : inputs)
        if (input != kStream && !input.empty() && same_file(path, input))
            throw FileError(fmt::format("{}: is also an input; it will not be replaced", path));
    std::error_code none;
    if (fs::is_directory(path, none)) throw FileError(fmt::format("{}: cannot be written: is a folder", path));
    const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
    if (!fs::is_directory(folder, none)) throw FileError(fmt::format("{}: no such folder: {}", path, folder.string()));
    const bool exists = fs::exists(path, none);
    const bool writable = ::access(exists ? path.c_str() : folder.c_str(), W_OK) == 0 &&
                          (is_special(path) || ::access(folder.c_str(), W_OK) == 0);
    if (!writable) fail_write(path, errno);
}

void put(const std::string& path, std::string_view bytes, Interrupt& interrupt) {
    const Commit commit(interrupt);
    if (path == kStream)
        write_all(STDOUT_FILENO, bytes, path);
    else if (is_special(path))
        write_special(path, bytes);
    else
        atomic_write(path, bytes);
}

}  // namespace fretwork::cli
