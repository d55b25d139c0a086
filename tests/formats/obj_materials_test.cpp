// Colours of OBJ files: a second file beside the first.
#include "formats/obj_materials.h"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "core/base/error.h"
#include "formats/mesh_file.h"
#include "formats/obj_reader.h"
#include "formats/read_file.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

namespace fs = std::filesystem;

/// Gone with this.
struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "fretwork_XXXXXX").string();
        REQUIRE(::mkdtemp(name.data()) != nullptr);
        path = name;
    }
    ~Folder() { fs::remove_all(path); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
};

TEST_CASE("obj: colours survive in a file of materials beside it", "[formats]") {
    const Folder folder;
    const TriangleMesh mesh = testing::make_icosphere(3.0, 1);
    std::vector<Rgb8> colors;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        colors.push_back({static_cast<std::uint8_t>(t), static_cast<std::uint8_t>(3 * t), 255});
    const fs::path path = folder.path / "a part #1.obj";
    write_mesh(path, {mesh, colors, "part"});
    CHECK(fs::exists(folder.path / "a_part__1.mtl"));
    const MeshFile file = read_mesh(path);
    CHECK(file.triangle_colors == colors);
    CHECK(file.warnings.empty());
    REQUIRE(file.read_beside.size() == 1);
    CHECK(file.read_beside[0].path == obj_materials_path(path));
    CHECK(file.read_beside[0].bytes == read_file(obj_materials_path(path)));

    fs::remove(obj_materials_path(path));
    const MeshFile bare = read_mesh(path);
    CHECK(bare.triangle_colors.empty());
    CHECK(bare.mesh.triangles == mesh.triangles);
    REQUIRE(bare.warnings.size() == 1);
    CHECK(bare.warnings[0].find("a_part__1.mtl") != std::string::npos);
}

TEST_CASE("obj: libraries outside of the folder are not read", "[formats][errors]") {
    const Folder folder;
    fs::create_directory(folder.path / "inner");
    std::ofstream(folder.path / "secret.mtl") << "newmtl m\nKd 1 0 0\n";
    std::ofstream(folder.path / "inner" / "a.obj")
        << "mtllib ../secret.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
    const MeshFile file = read_mesh(folder.path / "inner" / "a.obj");
    CHECK(file.triangle_colors.empty());
    CHECK(file.read_beside.empty());
    CHECK(file.warnings.size() == 1);
}

TEST_CASE("obj: a material goes before colours of corners, and only where it is in use", "[formats]") {
    const std::string obj =
        "mtllib m.mtl\nv 0 0 0 0 0 1\nv 1 0 0 0 0 1\nv 0 1 0 0 0 1\nf 1 2 3\nusemtl red\nf 1 2 3\nusemtl none\n"
        "f 1 2 3\n";
    const ObjMaterialFiles files = [](std::string_view name) -> std::optional<std::string> {
        CHECK(name == "m.mtl");
        return "newmtl red\n  Kd 1 0 0\nmap_Kd a.png\nnewmtl grey\nKd 0.5\nnewmtl odd\nKd spectral file.rfl\n";
    };
    const MeshFile file = read_obj(obj, "a.obj", files);
    CHECK(file.triangle_colors == std::vector<Rgb8>{{0, 0, 255}, {255, 0, 0}, {0, 0, 255}});
}

TEST_CASE("obj: materials with mistakes are named", "[formats][errors]") {
    CHECK(read_obj_materials("newmtl grey\nKd 0.5\n", "m").at("grey") == Rgb8{128, 128, 128});
    CHECK_THROWS_WITH(read_obj_materials("newmtl a\nKd 1 red 0\n", "m.mtl"),
                      Catch::Contains("m.mtl") && Catch::Contains("line 2") && Catch::Contains("red"));
    CHECK_THROWS_AS(read_obj_materials("newmtl\n", "m.mtl"), InvalidInput);
}

}  // namespace
}  // namespace fretwork
