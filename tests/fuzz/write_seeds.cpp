// Writes a small corpus of sound files, one folder per fuzz target: write_seeds FOLDER
#include <cstdio>
#include <filesystem>
#include <string>

#include "formats/atomic_write.h"
#include "formats/carved_threemf_writer.h"
#include "formats/mesh_file.h"
#include "formats/png_writer.h"
#include "formats/zip_reader.h"

namespace {

using namespace fretwork;

TriangleMesh tetrahedron() {
    return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1.5, 0), Vec3(0, 0, -2)},
            {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
}

std::string carved_package() {
    const TriangleMesh mesh = tetrahedron();
    const std::vector<Rgb8> colors = {{1, 2, 3}, {1, 2, 3}, {200, 2, 3}, {1, 2, 255}};
    SurfaceVoxels shell;
    shell.grid.extent = {2, 2, 1};
    shell.coords = {{0, 0, 0}, {1, 1, 0}};
    const SolidStates solid = {SolidState::kSolid, SolidState::kEmpty};
    const VoxelData voxels{shell, solid};
    CarvedPackage package;
    package.objects.push_back({mesh, colors, "seed", &voxels});
    package.spec_toml = "seed = 1\n";
    return write_carved_threemf(package);
}

void write(const std::filesystem::path& folder, const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories(folder);
    atomic_write(folder / name, bytes);
}

}  // namespace

int main(int count, char** arguments) {
    if (count != 2) {
        std::fputs("usage: write_seeds FOLDER\n", stderr);
        return 1;
    }
    const std::filesystem::path root = arguments[1];
    const TriangleMesh mesh = tetrahedron();
    const std::vector<Rgb8> colors(4, Rgb8{10, 20, 30});
    write(root / "stl", "binary.stl", write_mesh({mesh}, MeshFormat::kStl));
    write(root / "stl", "ascii.stl",
          "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"
          "endsolid a\n");
    write(root / "obj", "plain.obj", write_mesh({mesh, {}, "seed"}, MeshFormat::kObj));
    write(root / "obj", "polygon.obj", "v 0 0 0 1 0 0\nv 2 3 0\nv 0 1 0\nv -2 3 0\ng x\nf 1/1 2//2 3/1/1 \\\n-1\n");
    write(root / "mtl", "plain.mtl", "newmtl a b\nKd 0.1 0.2 0.3\nmap_Kd x.png\nnewmtl c\nKd .5 # grey\n");
    write(root / "amf", "plain.amf", write_mesh({mesh, colors, "seed"}, MeshFormat::kAmf));
    write(root / "amf", "placed.amf",
          "<amf unit=\"inch\"><material id=\"1\"><color><r>1</r><g>.5</g><b>0</b></color></material><object id=\"2\">"
          "<mesh><vertices><vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex><vertex><coordinates>"
          "<x>1</x><y>0</y><z>0</z></coordinates></vertex><vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates>"
          "</vertex></vertices><volume materialid=\"1\"><triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume>"
          "</mesh></object><constellation id=\"3\"><instance objectid=\"2\"><deltax>5</deltax><rz>90</rz></instance>"
          "</constellation></amf>");
    write(root / "parameter_set", "sets.json",
          "{\"parameterSets\": {\"a\": {\"synthesis.seed\": \"5\"}}, \"fileFormatVersion\": \"1\"}");
    write(
        root / "gcode", "two_layers.gcode",
        "; external perimeters extrusion width = "
        "0.45mm\nG90\nM83\n;TYPE:Perimeter\n;LAYER_CHANGE\n;Z:0.2\n;HEIGHT:0.2\n"
        "G1 X5 Y5 F900\nG1 X9 Y5 E.5\n;Z:0.6\nG1 Z.6\nG1 X9 Y9 E1e-1\nG92 E0\nG91\nG1 X-1 E1\n"
        "; estimated printing time (normal mode) = 1h 2m 3s\n; bed_shape = 0x0,50x0,50x40\n; max_print_height = 30\n");
    write(root / "ply", "binary.ply", write_mesh({mesh, colors}, MeshFormat::kPly));
    write(
        root / "ply", "ascii.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar "
        "red\nproperty uchar green\nproperty uchar blue\nelement tristrips 1\nproperty list uchar int "
        "vertex_indices\nend_header\n0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n5 0 1 2 -1 0\n");
    write(root / "off", "plain.off", write_mesh({mesh, colors}, MeshFormat::kOff));
    write(root / "off", "coff.off", "COFF\n3 1 3\n0 0 0 .1 .2 .3 1\n1 0 0 0 0 0 1\n0 1 0 9 9 9 9\n3 0 1 2 7\n");
    const std::string package = carved_package();
    write(root / "threemf_package", "carved.3mf", package);
    write(root / "threemf_model", "carved.model", ZipReader(package, "seed").read("3D/3dmodel.model", 1 << 20));
    write(root / "threemf_model", "build.model",
          "<model unit=\"inch\" xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><resources>"
          "<basematerials id=\"1\"><base name=\"a\" displaycolor=\"#01020304\"/></basematerials><object id=\"2\">"
          "<components><component objectid=\"3\" transform=\"1 0 0 0 1 0 0 0 1 2 3 4\"/></components></object>"
          "</resources><build><item objectid=\"2\"/></build></model>");
    Image image{3, 2, std::vector<Rgba8>(6, Rgba8{9, 8, 7, 6}), true};
    write(root / "image", "rgba.png", write_png(image));
    write(root / "toml", "spec.toml", "a = 1\n[b]\nc = [1, 2.5]\nd = \"x\\u00e9\"\n[[e]]\nf = true\n[[e]]\nf = 1e3\n");
    return 0;
}
