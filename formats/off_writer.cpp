#include "formats/off_writer.h"

#include "formats/number_text.h"

namespace fretwork {
namespace {

void append_vertices(std::string& out, const TriangleMesh& mesh, CoordinatePrecision precision) {
    for (const Vec3& p : mesh.positions_mm)
        for (int k = 0; k < 3; ++k) {
            append_coordinate(out, p[k], precision);
            out += k < 2 ? ' ' : '\n';
        }
}

}  // namespace

std::string write_off(const MeshToWrite& input) {
    check_mesh_to_write(input);
    std::string out = "OFF\n";
    out.reserve(64 + 32 * input.mesh.positions_mm.size() + 36 * input.mesh.triangles.size());
    append_number(out, input.mesh.positions_mm.size());
    out += ' ';
    append_number(out, input.mesh.triangles.size());
    out += " 0\n";
    append_vertices(out, input.mesh, input.precision);
    for (std::size_t t = 0; t < input.mesh.triangles.size(); ++t) {
        out += '3';
        for (const std::uint32_t v : input.mesh.triangles[t]) {
            out += ' ';
            append_number(out, v);
        }
        if (!input.triangle_colors.empty())
            for (const std::uint8_t channel : input.triangle_colors[t]) {
                out += ' ';
                append_number(out, unsigned{channel});
            }
        out += '\n';
    }
    return out;
}

}  // namespace fretwork
