#include "formats/ply_writer.h"

#include "formats/byte_order.h"

namespace fretwork {
namespace {

std::string header_of(const MeshToWrite& input) {
    const std::string type = input.precision == CoordinatePrecision::kFloat ? "float" : "double";
    std::string out = "ply\nformat binary_little_endian 1.0\ncomment Fretwork, millimetres\nelement vertex ";
    out += std::to_string(input.mesh.positions_mm.size());
    for (const std::string_view axis : {"x", "y", "z"}) out.append("\nproperty ").append(type).append(" ").append(axis);
    out += "\nelement face " + std::to_string(input.mesh.triangles.size());
    out += "\nproperty list uchar int vertex_indices";
    if (!input.triangle_colors.empty()) out += "\nproperty uchar red\nproperty uchar green\nproperty uchar blue";
    return out + "\nend_header\n";
}

}  // namespace

std::string write_ply(const MeshToWrite& input) {
    check_mesh_to_write(input);
    std::string out = header_of(input);
    out.reserve(out.size() + 24 * input.mesh.positions_mm.size() + 16 * input.mesh.triangles.size());
    for (const Vec3& p : input.mesh.positions_mm)
        for (int k = 0; k < 3; ++k) {
            if (input.precision == CoordinatePrecision::kFloat) {
                append_little(out, static_cast<float>(p[k]));
            } else {
                append_little(out, p[k]);
            }
        }
    for (std::size_t t = 0; t < input.mesh.triangles.size(); ++t) {
        out += '\3';
        for (const std::uint32_t v : input.mesh.triangles[t]) append_little(out, v);
        if (!input.triangle_colors.empty())
            for (const std::uint8_t channel : input.triangle_colors[t]) out += static_cast<char>(channel);
    }
    return out;
}

}  // namespace fretwork
