#include "formats/obj_writer.h"

#include "formats/number_text.h"
#include "formats/obj_materials.h"

namespace fretwork {
namespace {

void append_vertices(std::string& out, const TriangleMesh& mesh, CoordinatePrecision precision) {
    for (const Vec3& p : mesh.positions_mm) {
        out += 'v';
        for (int k = 0; k < 3; ++k) {
            out += ' ';
            append_coordinate(out, p[k], precision);
        }
        out += '\n';
    }
}

/// One word per name: blanks would make several groups of it.
std::string one_word(std::string_view name) {
    std::string word(name);
    for (char& c : word)
        if (static_cast<unsigned char>(c) <= ' ' || c == '#' || c == '\\') c = '_';
    return word;
}

}  // namespace

std::string write_obj(const MeshToWrite& input) {
    check_mesh_to_write(input);
    std::string out = "# Fretwork, millimetres\n";
    out.reserve(64 + 32 * input.mesh.positions_mm.size() + 24 * input.mesh.triangles.size());
    if (!input.name.empty()) out.append("o ").append(one_word(input.name)).append("\n");
    const bool colored = !input.triangle_colors.empty() && !input.obj_materials.empty();
    if (colored) out.append("mtllib ").append(one_word(input.obj_materials)).append("\n");
    append_vertices(out, input.mesh, input.precision);
    for (std::size_t t = 0; t < input.mesh.triangles.size(); ++t) {
        if (colored && (t == 0 || input.triangle_colors[t] != input.triangle_colors[t - 1]))
            out.append("usemtl ").append(obj_material_name(input.triangle_colors[t])).append("\n");
        out += 'f';
        for (const std::uint32_t v : input.mesh.triangles[t]) {
            out += ' ';
            append_number(out, v + std::uint64_t{1});
        }
        out += '\n';
    }
    return out;
}

}  // namespace fretwork
