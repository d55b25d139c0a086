#include "support/make_packages.h"

#include <stdexcept>

#include "formats/threemf_names.h"
#include "formats/zip_writer.h"

namespace fretwork::testing {

std::string make_zip(const Parts& parts) {
    ZipWriter zip;
    for (const auto& [name, text] : parts) zip.add(name, text);
    return zip.finish();
}

std::string make_package(const std::string& model_xml, const Parts& more) {
    Parts parts = {
        {"[Content_Types].xml",
         "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
         "<Default Extension=\"model\" "
         "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>"},
        {"_rels/.rels",
         "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship Id=\"r\" "
         "Target=\"/3D/3dmodel.model\" Type=\"" +
             std::string(threemf::kModelRelation) + "\"/></Relationships>"},
        {"3D/3dmodel.model", model_xml}};
    parts.insert(parts.end(), more.begin(), more.end());
    return make_zip(parts);
}

std::string make_zip_bomb(std::size_t megabytes) {
    ZipWriter zip;
    zip.add_deflated("3D/3dmodel.model",
                     deflate_pieces(megabytes, [](std::size_t) { return std::string(1 << 20, ' '); }));
    return zip.finish();
}

std::string make_model(const std::string& resources, const std::string& build, const std::string& attributes) {
    const auto space = [](std::string_view prefix, std::string_view uri) {
        return " xmlns" + std::string(prefix) + "=\"" + std::string(uri) + "\"";
    };
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model" + space("", threemf::kCore) +
           space(":m", threemf::kMaterial) + space(":v", threemf::kVolumetric) + space(":p", threemf::kProduction) +
           space(":fw", threemf::kFretwork) + " " + attributes + ">\n<resources>\n" + resources +
           "</resources>\n<build>" + build + "</build>\n</model>\n";
}

std::string make_tetrahedron(int id, const std::string& attributes, const std::string& triangle_attributes) {
    std::string xml = "<object id=\"" + std::to_string(id) + "\" " + attributes +
                      "><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/>"
                      "<vertex x=\"0\" y=\"1\" z=\"0\"/><vertex x=\"0\" y=\"0\" z=\"1\"/></vertices><triangles>\n";
    for (const std::string corners : {"v1=\"0\" v2=\"2\" v3=\"1\"", "v1=\"0\" v2=\"1\" v3=\"3\"",
                                      "v1=\"0\" v2=\"3\" v3=\"2\"", "v1=\"1\" v2=\"2\" v3=\"3\""})
        xml += "<triangle " + corners + " " + triangle_attributes + "/>\n";
    return xml + "</triangles></mesh></object>\n";
}

std::string patched(std::string bytes, std::string_view from, std::string_view to) {
    if (from.size() != to.size()) throw std::logic_error("patched: lengths differ");
    std::size_t count = 0;
    for (std::size_t at = bytes.find(from); at != bytes.npos; at = bytes.find(from, at + to.size()), ++count)
        bytes.replace(at, from.size(), to);
    if (count == 0) throw std::logic_error("patched: nothing found");
    return bytes;
}

std::string with_central_field(std::string bytes, std::size_t offset, std::uint32_t value, int size) {
    constexpr std::string_view kRecord("PK\x01\x02", 4);
    for (std::size_t at = bytes.find(kRecord); at != bytes.npos; at = bytes.find(kRecord, at + 4))
        for (int i = 0; i < size; ++i)
            bytes[at + offset + static_cast<std::size_t>(i)] = static_cast<char>(value >> (8 * i) & 0xFF);
    return bytes;
}

}  // namespace fretwork::testing
