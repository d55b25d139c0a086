#include "formats/mesh_file.h"

#include <array>
#include <utility>

#include "core/base/error.h"
#include "formats/amf_reader.h"
#include "formats/amf_writer.h"
#include "formats/atomic_write.h"
#include "formats/cad_reader.h"
#include "formats/carved_threemf_writer.h"
#include "formats/glb_writer.h"
#include "formats/lower_case.h"
#include "formats/obj_materials.h"
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

constexpr std::array<std::pair<std::string_view, MeshFormat>, 13> kFormats = {{
    {"stl", MeshFormat::kStl},
    {"obj", MeshFormat::kObj},
    {"ply", MeshFormat::kPly},
    {"off", MeshFormat::kOff},
    {"3mf", MeshFormat::kThreemf},
    {"amf", MeshFormat::kAmf},
    {"glb", MeshFormat::kGlb},
    {"step", MeshFormat::kStep},
    {"stp", MeshFormat::kStep},
    {"iges", MeshFormat::kIges},
    {"igs", MeshFormat::kIges},
    {"brep", MeshFormat::kBrep},
    {"brp", MeshFormat::kBrep},
}};

MeshFile read_cad_format(std::string_view bytes, MeshFormat format, std::string_view source, const CadMeshing& meshing,
                         const RunControl& run) {
#ifdef FRETWORK_STEP
    const CadFormat cad = format == MeshFormat::kStep   ? CadFormat::kStep
                          : format == MeshFormat::kIges ? CadFormat::kIges
                                                        : CadFormat::kBrep;
    return read_cad(bytes, cad, source, meshing, run);
#else
    static_cast<void>(bytes);
    static_cast<void>(format);
    static_cast<void>(meshing);
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
    const std::string lower = lower_case(name.substr(name.starts_with('.') ? 1 : 0));
    std::string known;
    for (const auto& [word, format] : kFormats) {
        if (word == lower) return format;
        known.append(known.empty() ? "" : ", ").append(word);
    }
    throw InvalidSetting("mesh format: found " + in_quotes(name) + ", expected one of " + known);
}

std::string_view mesh_format_name(MeshFormat format) {
    for (const auto& [word, known] : kFormats)
        if (known == format) return word;
    return {};
}

MeshFormat mesh_format_from_path(const std::filesystem::path& path) {
    try {
        return mesh_format_from_name(path.extension().string());
    } catch (const InvalidSetting& unknown) {
        throw InvalidSetting(path.string() + ": " + unknown.what());
    }
}

namespace {

MeshFile read_format(std::string_view bytes, MeshFormat format, std::string_view source, const MeshReadOptions& options,
                     const ObjMaterialFiles& materials, const RunControl& run) {
    switch (format) {
        case MeshFormat::kStl:
            return read_stl(bytes, source, run);
        case MeshFormat::kObj:
            return read_obj(bytes, source, materials, run);
        case MeshFormat::kPly:
            return read_ply(bytes, source, run);
        case MeshFormat::kOff:
            return read_off(bytes, source, run);
        case MeshFormat::kThreemf:
            return read_threemf(bytes, source, run, {options.ignore_required});
        case MeshFormat::kAmf:
            return read_amf(bytes, source, run);
        case MeshFormat::kStep:
        case MeshFormat::kIges:
        case MeshFormat::kBrep:
            return read_cad_format(bytes, format, source, options.cad, run);
        case MeshFormat::kGlb:
            break;
    }
    throw InvalidSetting(std::string(source) + ": found GLB, which is only written, expected a format to read");
}

}  // namespace

MeshFile read_mesh(std::string_view bytes, MeshFormat format, std::string_view source, const MeshReadOptions& options,
                   const RunControl& run) {
    std::vector<FileBeside> beside;
    const ObjMaterialFiles materials = [&](std::string_view name) -> std::optional<std::string> {
        const std::filesystem::path own_name = std::filesystem::path(name).filename();
        if (const auto here = options.materials.find(own_name.string()); here != options.materials.end())
            return here->second;
        if (!options.folder) return std::nullopt;
        const std::filesystem::path file = *options.folder / own_name;
        std::error_code none;
        if (!std::filesystem::is_regular_file(file, none)) return std::nullopt;
        beside.push_back({file, read_file(file)});
        return beside.back().bytes;
    };
    MeshFile file = read_format(bytes, format, source, options, materials, run);
    file.read_beside = std::move(beside);
    if (file.mesh.triangles.empty())
        fail_parse(source, place_of_byte(bytes.size()), "no triangle in the whole file", "at least one");
    const bool has_unit = format == MeshFormat::kThreemf || format == MeshFormat::kAmf || format == MeshFormat::kStep ||
                          format == MeshFormat::kIges;
    if (!has_unit && options.unit != LengthUnit::kMillimeter) {
        file.unit = options.unit;
        for (Vec3& p : file.mesh.positions_mm) p *= millimeters_per(options.unit);
    }
    return file;
}

MeshFile read_mesh(const std::filesystem::path& path, const MeshReadOptions& options, const RunControl& run) {
    MeshReadOptions here = options;
    if (!here.format) here.format = mesh_format_from_path(path);
    here.folder = path.parent_path();
    return read_mesh(read_file(path), *here.format, path.string(), here, run);
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
        case MeshFormat::kAmf:
            return write_amf(input);
        case MeshFormat::kGlb:
            return write_glb(input);
        case MeshFormat::kStep:
        case MeshFormat::kIges:
        case MeshFormat::kBrep:
            break;
    }
    throw InvalidSetting(
        "mesh format: found a CAD format, expected one that holds triangles: stl, obj, ply, off, 3mf, amf, glb");
}

std::filesystem::path obj_materials_path(const std::filesystem::path& path) {
    std::string name = path.stem().string() + ".mtl";
    // A name of several words would name several libraries.
    for (char& c : name)
        if (static_cast<unsigned char>(c) <= ' ' || c == '#' || c == '\\') c = '_';
    return std::filesystem::path(path).replace_filename(name);
}

void write_mesh(const std::filesystem::path& path, const MeshToWrite& input, std::optional<MeshFormat> format) {
    const MeshFormat chosen = format ? *format : mesh_format_from_path(path);
    if (chosen != MeshFormat::kObj || input.triangle_colors.empty()) {
        atomic_write(path, write_mesh(input, chosen));
        return;
    }
    MeshToWrite with_materials = input;
    const std::filesystem::path materials = obj_materials_path(path);
    const std::string name = materials.filename().string();
    with_materials.obj_materials = name;
    const std::string bytes = write_mesh(with_materials, chosen);
    atomic_write(materials, write_obj_materials(input.triangle_colors));
    atomic_write(path, bytes);
}

}  // namespace fretwork
