// The programs our files are made for agree with us about them.
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>

#include "formats/atomic_write.h"
#include "formats/carved_threemf_writer.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

namespace fs = std::filesystem;

/// What a program prints, or nothing when it is not installed. Always under a time limit: some of
/// these programs never end on files they do not like.
std::string output_of(const std::string& program, const std::string& arguments) {
    const std::string probe = "command -v " + program + " > /dev/null 2>&1";
    if (std::system(probe.c_str()) != 0) {
        WARN(program << " is not installed: skipped");
        return {};
    }
    const std::string command = "timeout 60 " + program + " " + arguments + " 2>&1";
    FILE* pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::string text;
    char block[4096];
    for (std::size_t got = 0; (got = std::fread(block, 1, sizeof block, pipe)) > 0;) text.append(block, got);
    CHECK(::pclose(pipe) == 0);
    return text;
}

/// The number behind the last occurrence of `label` and any of " :=(".
double number_after(const std::string& text, const std::string& label) {
    const std::size_t at = text.rfind(label);
    if (at == text.npos) return -1.0;
    const std::size_t begin = text.find_first_not_of(" :=(", at + label.size());
    return begin == text.npos ? -1.0 : std::atof(text.c_str() + begin);
}

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

std::vector<NamedMesh> models() {
    return {{"bracket", testing::make_bracket()},
            {"torus", testing::translated(testing::make_torus(20, 6, 48, 24), Vec3(40, 40, 6))},
            {"tori", testing::make_linked_tori(20, 4, 24, 12)}};
}

fs::path scratch(const std::string& name) {
    return fs::temp_directory_path() / ("fretwork_" + std::to_string(::getpid()) + "_" + name);
}

/// What a program has made of a file.
struct Loaded {
    double triangles = 0.0;
    double volume_mm3 = 0.0;
    Vec3 low_mm, high_mm;
};

Loaded measured(const TriangleMesh& mesh) {
    Loaded loaded{static_cast<double>(mesh.triangles.size()), testing::volume_mm3(mesh), mesh.positions_mm.front(),
                  mesh.positions_mm.front()};
    for (const Vec3& p : mesh.positions_mm) {
        loaded.low_mm = loaded.low_mm.cwiseMin(p);
        loaded.high_mm = loaded.high_mm.cwiseMax(p);
    }
    return loaded;
}

/// By a slicer's own words. It repairs before it counts: equal counts and volume say that there was nothing to repair.
std::optional<Loaded> loaded_by_slicer(const std::string& program, const fs::path& file) {
    const std::string said = output_of(program, "--info " + file.string());
    if (said.empty()) return std::nullopt;
    CHECK_THAT(said, Catch::Contains("manifold = yes"));
    return Loaded{number_after(said, "number_of_facets"), number_after(said, "volume"),
                  Vec3(number_after(said, "min_x"), number_after(said, "min_y"), number_after(said, "min_z")),
                  Vec3(number_after(said, "max_x"), number_after(said, "max_y"), number_after(said, "max_z"))};
}

std::optional<Loaded> loaded_by_admesh(const fs::path& file) {
    const std::string said = output_of("admesh", file.string());
    if (said.empty()) return std::nullopt;
    for (const std::string fault : {"Degenerate facets", "Facets reversed", "Normals fixed", "Backwards edges"})
        CHECK(number_after(said, fault) == 0);
    return Loaded{number_after(said, "Number of facets"), number_after(said, "Volume"),
                  Vec3(number_after(said, "Min X"), number_after(said, "Min Y"), number_after(said, "Min Z")),
                  Vec3(number_after(said, "Max X"), number_after(said, "Max Y"), number_after(said, "Max Z"))};
}

/// What a program has loaded and written anew as an STL.
std::optional<Loaded> loaded_through_stl(const std::string& program, const std::string& arguments,
                                         const fs::path& stl) {
    const std::string said = output_of(program, arguments);
    if (said.empty()) return std::nullopt;
    CAPTURE(said);
    REQUIRE(fs::exists(stl));
    const Loaded loaded = measured(read_mesh(stl).mesh);
    fs::remove(stl);
    return loaded;
}

std::optional<Loaded> loaded_by_assimp(const fs::path& file) {
    const fs::path stl = scratch("assimp.stl");
    auto loaded = loaded_through_stl("assimp", "export " + file.string() + " " + stl.string() + " -fstlb", stl);
    // A glTF stands in metres with y up.
    if (loaded && file.extension() == ".glb") {
        const Vec3 low = 1000.0 * loaded->low_mm, high = 1000.0 * loaded->high_mm;
        loaded->low_mm = Vec3(low.x(), -high.z(), low.y());
        loaded->high_mm = Vec3(high.x(), -low.z(), high.y());
        loaded->volume_mm3 *= 1e9;
    }
    return loaded;
}

std::optional<Loaded> loaded_by_openscad(const fs::path& file) {
    const fs::path stl = scratch("openscad.stl"), scad = scratch("import.scad");
    atomic_write(scad, "import(\"" + file.string() + "\");\n");
    auto loaded = loaded_through_stl("openscad", "-o " + stl.string() + " " + scad.string(), stl);
    fs::remove(scad);
    return loaded;
}

/// A program and what it says it can load of what we write.
struct Reader {
    std::string program;
    std::vector<std::string> extensions;
    std::function<std::optional<Loaded>(const fs::path&)> load;
    double size_margin_mm = 1e-5;  ///< half of the last digit that it prints, and that of a float
};

std::vector<Reader> readers() {
    std::vector<Reader> all;
    for (const std::string slicer : {"prusa-slicer", "slic3r"})
        all.push_back({slicer, {".stl", ".obj", ".3mf", ".amf"}, [slicer](const fs::path& file) {
                           return loaded_by_slicer(slicer, file);
                       }});
    all.push_back({"admesh", {".stl"}, loaded_by_admesh});
    all.push_back({"assimp", {".stl", ".obj", ".ply", ".off", ".3mf", ".amf", ".glb"}, loaded_by_assimp});
    all.push_back({"openscad", {".stl", ".off", ".3mf", ".amf"}, loaded_by_openscad, 1e-4});
    return all;
}

void check_loaded(const Reader& reader, const TriangleMesh& mesh, const Loaded& loaded) {
    const Loaded expected = measured(mesh);
    CHECK(loaded.triangles == expected.triangles);
    CHECK(loaded.volume_mm3 == Approx(expected.volume_mm3).epsilon(1e-4));
    for (int axis = 0; axis < 3; ++axis) {
        CHECK(loaded.low_mm[axis] == Approx(expected.low_mm[axis]).margin(reader.size_margin_mm));
        CHECK(loaded.high_mm[axis] == Approx(expected.high_mm[axis]).margin(reader.size_margin_mm));
    }
}

TEST_CASE("programs load all that they claim to of what we write: triangles, volume and box", "[formats][programs]") {
    for (const Reader& reader : readers())
        for (const NamedMesh& model : models())
            for (const std::string& extension : reader.extensions) {
                CAPTURE(reader.program, model.name, extension);
                const std::vector<Rgb8> colors(model.mesh.triangles.size(), Rgb8{200, 50, 50});
                const fs::path path = scratch(model.name + extension);
                write_mesh(path, {model.mesh, colors, model.name});
                const auto loaded = reader.load(path);
                fs::remove(path);
                if (extension == ".obj") fs::remove(obj_materials_path(path));
                if (loaded) check_loaded(reader, model.mesh, *loaded);
            }
}

TEST_CASE("programs load a carved package with voxel data and paint", "[formats][programs]") {
    const TriangleMesh mesh = testing::make_bracket();
    SurfaceVoxels shell;
    shell.grid.extent = {4, 4, 4};
    shell.coords = {{0, 0, 0}, {3, 2, 1}};
    const SolidStates solid = {SolidState::kSolid, SolidState::kEmpty};
    const std::vector<std::uint8_t> reinforced = {1, 0};
    const std::vector<Rgb8> colors = {{1, 2, 3}, {4, 5, 6}};
    const VoxelData voxels{shell, solid, reinforced, colors};
    std::vector<Rgb8> triangle_colors;
    std::vector<std::uint8_t> extruders;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        triangle_colors.push_back({static_cast<std::uint8_t>(t % 5), 20, 30});
        extruders.push_back(static_cast<std::uint8_t>(t % 5 + 1));
    }
    CarvedPackage package;
    package.objects.push_back({mesh, triangle_colors, "bracket", &voxels, nullptr, {PaintFormat::kPrusa, extruders}});
    package.spec_toml = "seed = 1\n";
    for (const Reader& reader : readers()) {
        if (std::ranges::find(reader.extensions, ".3mf") == reader.extensions.end()) continue;
        CAPTURE(reader.program);
        const fs::path path = scratch("carved.3mf");
        write_carved_threemf(path, package);
        const auto loaded = reader.load(path);
        fs::remove(path);
        if (loaded) check_loaded(reader, mesh, *loaded);
    }
}

TEST_CASE("our reader takes what PrusaSlicer writes", "[formats][programs]") {
    const TriangleMesh mesh = testing::make_bracket();
    const fs::path from = scratch("from.stl"), to = scratch("to.3mf");
    write_mesh(from, {mesh});
    const std::string said = output_of("prusa-slicer", "--export-3mf -o " + to.string() + " " + from.string());
    fs::remove(from);
    if (said.empty()) return;
    const MeshFile file = read_mesh(to);
    fs::remove(to);
    CHECK(file.mesh.triangles.size() == mesh.triangles.size());
    CHECK(testing::volume_mm3(file.mesh) == Approx(testing::volume_mm3(mesh)).epsilon(1e-4));
}

}  // namespace
}  // namespace fretwork
