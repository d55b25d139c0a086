#include "formats/mesh_file.h"

#include <array>
#include <cctype>
#include <utility>

#include "core/base/error.h"
#include "formats/atomic_write.h"
#include "formats/cad_reader.h"
#include "formats/carved_threemf_writer.h"
#include "formats/obj_reader.h"
#include "formats/obj_writer.h"
#include "formats/off_reader.h"
#include "formats/off_writer.h"
#include "formats/parse_error.h"
#include "formats/ply_reader.h"
#include "formats/ply_writer.h"
#include "formats/read_file.h"
#include "formats/stl_reader.h"
#include "formats/stl_writer.h"
#include "formats/threemf_reader.h"

namespace fretwork {
namespace {

constexpr std::array<std::pair<std::string_view, MeshFormat>, 11> kFormats = {{
    {"stl", MeshFormat::kStl},
    {"obj", MeshFormat::kObj},
    {"ply", MeshFormat::kPly},
    {"off", MeshFormat::kOff},
    {"3mf", MeshFormat::kThreemf},
    {"step", MeshFormat::kStep},
    {"stp", MeshFormat::kStep},
    {"iges", MeshFormat::kIges},
    {"igs", MeshFormat::kIges},
    {"brep", MeshFormat::kBrep},
    {"brp", MeshFormat::kBrep},
}};

MeshFile read_cad_format(std::string_view bytes, MeshFormat format, std::string_view source, const RunControl& run) {
#ifdef FRETWORK_STEP
    const CadFormat cad = format == MeshFormat::kStep   ? CadFormat::kStep
                          : format == MeshFormat::kIges ? CadFormat::kIges
                                                        : CadFormat::kBrep;
    return read_cad(bytes, cad, source, {}, run);
#else
    static_cast<void>(bytes);
    static_cast<void>(format);
    run.throw_if_stopped();
    throw InvalidSetting(std::string(source) + ": found a CAD model, expected a mesh: built without OpenCASCADE");
#endif
}

std::string write_threemf(const MeshToWrite& input) {
    CarvedPackage package;
    package.objects.push_back({input.mesh, input.triangle_colors, std::string(input.name)});
    package.title = input.name;
    return write_carved_threemf(package);
}

}  // namespace

MeshFormat mesh_format_from_name(std::string_view name) {
    std::string lower(name.substr(name.starts_with('.') ? 1 : 0));
    for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    std::string known;
    for (const auto& [word, format] : kFormats) {
        if (word == lower) return format;
        known.append(known.empty() ? "" : ", ").append(word);
    }
    throw InvalidSetting("mesh format: found " + in_quotes(name) + ", expected one of " + known);
}

MeshFormat mesh_format_from_path(const std::filesystem::path& path) {
    try {
        return mesh_format_from_name(path.extension().string());
    } catch (const InvalidSetting& unknown) {
        throw InvalidSetting(path.string() + ": " + unknown.what());
    }
}

MeshFile read_mesh(std::string_view bytes, MeshFormat format, std::string_view source, LengthUnit unit,
                   const RunControl& run) {
    MeshFile file;
    switch (format) {
        case MeshFormat::kStl:
            file = read_stl(bytes, source, run);
            break;
        case MeshFormat::kObj:
            file = read_obj(bytes, source, run);
            break;
        case MeshFormat::kPly:
            file = read_ply(bytes, source, run);
            break;
        case MeshFormat::kOff:
            file = read_off(bytes, source, run);
            break;
        case MeshFormat::kThreemf:
            file = read_threemf(bytes, source, run);
            break;
        case MeshFormat::kStep:
        case MeshFormat::kIges:
        case MeshFormat::kBrep:
            file = read_cad_format(bytes, format, source, run);
            break;
    }
    if (file.mesh.triangles.empty())
        fail_parse(source, place_of_byte(bytes.size()), "no triangle in the whole file", "at least one");
    const bool has_unit = format == MeshFormat::kThreemf || format == MeshFormat::kStep || format == MeshFormat::kIges;
    if (!has_unit && unit != LengthUnit::kMillimeter) {
        file.unit = unit;
        for (Vec3& p : file.mesh.positions_mm) p *= millimeters_per(unit);
    }
    return file;
}

MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options, const RunControl& run) {
    const MeshFormat format = options.format ? *options.format : mesh_format_from_path(path);
    return read_mesh(read_file(path), format, path.string(), options.unit, run);
}

std::string write_mesh(const MeshToWrite& input, MeshFormat format) {
    switch (format) {
        case MeshFormat::kStl:
            return write_stl(input);
        case MeshFormat::kObj:
            return write_obj(input);
        case MeshFormat::kPly:
            return write_ply(input);
        case MeshFormat::kOff:
            return write_off(input);
        case MeshFormat::kThreemf:
            return write_threemf(input);
        case MeshFormat::kStep:
        case MeshFormat::kIges:
        case MeshFormat::kBrep:
            break;
    }
    throw InvalidSetting("mesh format: found a CAD format, expected one that holds triangles: stl, obj, ply, off, 3mf");
}

void write_mesh(const std::filesystem::path& path, const MeshToWrite& input, std::optional<MeshFormat> format) {
    atomic_write(path, write_mesh(input, format ? *format : mesh_format_from_path(path)));
}

}  // namespace fretwork
