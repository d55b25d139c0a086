#include "formats/obj_writer.h"

#include "formats/number_text.h"

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
    append_vertices(out, input.mesh, input.precision);
    for (const Triangle& t : input.mesh.triangles) {
        out += 'f';
        for (const std::uint32_t v : t) {
            out += ' ';
            append_number(out, v + std::uint64_t{1});
        }
        out += '\n';
    }
    return out;
}

}  // namespace fretwork
