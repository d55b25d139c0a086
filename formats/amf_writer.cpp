#include "formats/amf_writer.h"

#include "formats/number_text.h"
#include "formats/xml_text.h"

namespace fretwork {
namespace {

void append_color(std::string& out, const Rgb8& color) {
    out += "<color>";
    for (std::size_t k = 0; k < 3; ++k) {
        const char channel = "rgb"[k];
        out.append("<").append(1, channel).append(">");
        append_number(out, static_cast<float>(color[k]) / 255.0F);
        out.append("</").append(1, channel).append(">");
    }
    out += "</color>";
}

void append_vertices(std::string& out, const MeshToWrite& input) {
    for (const Vec3& p : input.mesh.positions_mm) {
        out += "    <vertex><coordinates>";
        for (int k = 0; k < 3; ++k) {
            const char axis = "xyz"[k];
            out.append("<").append(1, axis).append(">");
            append_coordinate(out, p[k], input.precision);
            out.append("</").append(1, axis).append(">");
        }
        out += "</coordinates></vertex>\n";
    }
}

void append_triangles(std::string& out, const MeshToWrite& input) {
    for (std::size_t t = 0; t < input.mesh.triangles.size(); ++t) {
        out += "    <triangle>";
        if (!input.triangle_colors.empty()) append_color(out, input.triangle_colors[t]);
        for (std::size_t k = 0; k < 3; ++k) {
            const char corner = "123"[k];
            out.append("<v").append(1, corner).append(">");
            append_number(out, input.mesh.triangles[t][k]);
            out.append("</v").append(1, corner).append(">");
        }
        out += "</triangle>\n";
    }
}

}  // namespace

std::string write_amf(const MeshToWrite& input) {
    check_mesh_to_write(input);
    std::string out = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<amf unit=\"millimeter\" version=\"1.1\">\n";
    out.reserve(out.size() + 110 * input.mesh.positions_mm.size() +
                (input.triangle_colors.empty() ? 70 : 140) * input.mesh.triangles.size());
    out += " <metadata type=\"producer\">Fretwork</metadata>\n <object id=\"0\">\n";
    if (!input.name.empty()) out += "  <metadata type=\"name\">" + xml_escaped(input.name) + "</metadata>\n";
    out += "  <mesh>\n   <vertices>\n";
    append_vertices(out, input);
    out += "   </vertices>\n   <volume>\n";
    append_triangles(out, input);
    return out + "   </volume>\n  </mesh>\n </object>\n</amf>\n";
}

}  // namespace fretwork
