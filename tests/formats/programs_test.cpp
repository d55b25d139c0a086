// The programs our files are made for agree with us about them.
#include <unistd.h>
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <utility>

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

TEST_CASE("admesh reads our STL as we wrote it", "[formats][programs]") {
    for (const NamedMesh& model : models()) {
        CAPTURE(model.name);
        const fs::path path = scratch(model.name + ".stl");
        write_mesh(path, {model.mesh});
        const std::string said = output_of("admesh", path.string());
        fs::remove(path);
        if (said.empty()) return;
        CHECK(number_after(said, "Number of facets") == static_cast<double>(model.mesh.triangles.size()));
        CHECK(number_after(said, "Volume") == Approx(testing::volume_mm3(model.mesh)).epsilon(1e-4));
        CHECK(number_after(said, "Degenerate facets") == 0);
        CHECK(number_after(said, "Facets reversed") == 0);
        CHECK(number_after(said, "Normals fixed") == 0);
    }
}

/// slic3r repairs before it counts: equal counts and volume say that there was nothing to repair.
TEST_CASE("slicers find our STL, OBJ, 3MF and AMF closed, of the right volume and size", "[formats][programs]") {
    const std::string program = GENERATE("prusa-slicer", "slic3r");
    for (const NamedMesh& model : models()) {
        const std::vector<Rgb8> colors(model.mesh.triangles.size(), Rgb8{200, 50, 50});
        Vec3 low = model.mesh.positions_mm.front(), high = low;
        for (const Vec3& p : model.mesh.positions_mm) low = low.cwiseMin(p), high = high.cwiseMax(p);
        for (const std::string extension : {".stl", ".obj", ".3mf", ".amf"}) {
            CAPTURE(program, model.name, extension);
            const fs::path path = scratch(model.name + extension);
            write_mesh(path, {model.mesh, colors, model.name});
            const std::string said = output_of(program, "--info " + path.string());
            fs::remove(path);
            fs::remove(obj_materials_path(path));
            if (said.empty()) return;
            CHECK(number_after(said, "number_of_facets") == static_cast<double>(model.mesh.triangles.size()));
            CHECK(number_after(said, "volume") == Approx(testing::volume_mm3(model.mesh)).epsilon(1e-4));
            for (const auto& [label, axis] : {std::pair("size_x", 0), {"size_y", 1}, {"size_z", 2}})
                CHECK(number_after(said, label) == Approx(high[axis] - low[axis]).margin(2e-5));
            CHECK_THAT(said, Catch::Contains("manifold = yes"));
        }
    }
}

TEST_CASE("PrusaSlicer loads a carved package with voxel data", "[formats][programs]") {
    const TriangleMesh mesh = testing::make_bracket();
    SurfaceVoxels shell;
    shell.grid.extent = {4, 4, 4};
    shell.coords = {{0, 0, 0}, {3, 2, 1}};
    const SolidStates solid = {SolidState::kSolid, SolidState::kEmpty};
    const std::vector<std::uint8_t> reinforced = {1, 0};
    const std::vector<Rgb8> colors = {{1, 2, 3}, {4, 5, 6}};
    const VoxelData voxels{shell, solid, reinforced, colors};
    CarvedPackage package;
    package.objects.push_back({mesh, {}, "bracket", &voxels});
    package.spec_toml = "seed = 1\n";
    const fs::path path = scratch("carved.3mf");
    write_carved_threemf(path, package);
    const std::string said = output_of("prusa-slicer", "--info " + path.string());
    fs::remove(path);
    if (said.empty()) return;
    CHECK_THAT(said, Catch::Contains("manifold = yes"));
    CHECK(number_after(said, "number_of_facets") == static_cast<double>(mesh.triangles.size()));
}

TEST_CASE("assimp counts the triangles we wrote and finds the same box", "[formats][programs]") {
    for (const NamedMesh& model : models()) {
        const std::vector<Rgb8> colors(model.mesh.triangles.size(), Rgb8{200, 50, 50});
        for (const std::string extension : {".stl", ".obj", ".ply", ".off", ".glb"}) {
            CAPTURE(model.name, extension);
            const fs::path path = scratch(model.name + extension);
            write_mesh(path, {model.mesh, colors, model.name});
            const std::string said = output_of("assimp", "info " + path.string());
            fs::remove(path);
            fs::remove(obj_materials_path(path));
            if (said.empty()) return;
            CHECK(number_after(said, "Faces") == static_cast<double>(model.mesh.triangles.size()));
            // A glTF stands in metres with y up.
            const double unit = extension == ".glb" ? 1000.0 : 1.0;
            double highest = model.mesh.positions_mm.front()[0];
            for (const Vec3& p : model.mesh.positions_mm) highest = std::max(highest, p[0]);
            CHECK(unit * number_after(said, "Maximum point") == Approx(highest).margin(1e-6 * unit));
        }
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
