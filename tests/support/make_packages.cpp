#include "support/make_packages.h"

#include <sstream>
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

std::string make_mesh_object(int id, const TriangleMesh& mesh, const std::string& attributes) {
    std::ostringstream xml;
    xml << "<object id=\"" << id << "\" " << attributes << "><mesh><vertices>";
    for (const Vec3& p : mesh.positions_mm)
        xml << "<vertex x=\"" << p[0] << "\" y=\"" << p[1] << "\" z=\"" << p[2] << "\"/>\n";
    xml << "</vertices><triangles>";
    for (const Triangle& t : mesh.triangles)
        xml << "<triangle v1=\"" << t[0] << "\" v2=\"" << t[1] << "\" v3=\"" << t[2] << "\"/>\n";
    xml << "</triangles></mesh></object>\n";
    return xml.str();
}

namespace {

std::string project_model(const ProjectGaps& gaps) {
    const std::string tetrahedron = make_tetrahedron(0);
    const std::size_t begin = tetrahedron.find("<vertices>"), end = tetrahedron.find("</mesh>");
    const std::string mesh = gaps.mesh_content.empty() ? tetrahedron.substr(begin, end - begin) : gaps.mesh_content;
    return "<?xml version=\"1.0\" encoding=\"utf-8\" ?>\r\n<!-- made <by> hand -->\n"
           "<model  unit='millimeter' xml:lang=\"en\" requiredextensions=\"p\" recommendedextensions" +
           std::string(gaps.recommended == "x" ? "='x'" : "=\"" + gaps.recommended + "\"") +
           " xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"\n"
           "\txmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" xmlns:x=\"urn:x\" "
           "xmlns:m=\"urn:other\" xmlns:slic3rpe=\"http://schemas.slic3r.org/3mf/2017/06\"" +
           gaps.model +
           " >\n <metadata name=\"Title\">A &amp; B &#x3bc;</metadata><metadata name=\"x:note\" preserve=\"1\"> 1 "
           "<![CDATA[<mesh>]]></metadata>\n <resources >\n  <basematerials id=\"2\"><base name=\"red\" "
           "displaycolor=\"#FF0000\"/></basematerials>\n  <t:texture2d xmlns:t=\"http://schemas.microsoft.com/"
           "3dmanufacturing/material/2015/02\" id=\"3\" path=\"/3D/Textures/t.png\" contenttype=\"image/png\"/>\n"
           "  <x:unknown id=\"61\" ><object id=\"5\"><mesh/></object></x:unknown>\n  <!-- the wall -->" +
           gaps.before_object + "<object id=\"5\" name='wall' partnumber=\"W-1\" p:UUID=\"u-5\" x:more=\"&quot;\"" +
           gaps.object + "><metadatagroup><metadata name=\"x:price\">3</metadata></metadatagroup><mesh x:keep='a>b'" +
           gaps.mesh + ">" + mesh + "</mesh></object>\n  " +
           make_tetrahedron(6, "name=\"spare\" pid=\"2\" pindex=\"0\"",
                            "slic3rpe:mmu_segmentation=\"8\" paint_color='4'  paint_supports=\"4\"") +
           make_tetrahedron(7, "name=\"post\" type=\"support\"") +
           "<object id=\"8\" name=\"pair\" p:UUID=\"u-8\"><components><component objectid=\"5\" p:UUID=\"u-c\"/>"
           "<component objectid=\"5\" transform=\"2 0 0 0 2 0 0 0 2 9 0 0\"/></components></object></resources>\n"
           "<build p:UUID=\"u-b\"><item objectid=\"8\" partnumber=\"P\" x:y=\"z\"/><item objectid=\"6\" "
           "printable=\"0\"/><item objectid='7' /><item objectid=\"1\" p:path=\"/3D/Objects/other.model\" "
           "p:UUID=\"u-i\"/></build>\n <x:tail>&lt;</x:tail></model>\n<!-- end -->";
}

}  // namespace

std::string make_project(const ProjectGaps& gaps) {
    const std::string texture(threemf::kTextureRelation), thumbnail(threemf::kThumbnailRelation);
    return make_zip(
        {{"_rels/.rels",
          "<?xml version=\"1.0\"?><Relationships "
          "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">"
          "<Relationship Id=\"a\" Target=\"/3D/3dmodel.model\" Type=\"" +
              std::string(threemf::kModelRelation) +
              "\"/><Relationship Id=\"fretwork0\" Target=\"Metadata/thumbnail.png\" Type=\"" + thumbnail +
              "\"/><Relationship Id=\"c\" Target=\"/odd/part.bin\" Type=\"urn:odd\"/></Relationships>"},
         {"3D/3dmodel.model", project_model(gaps)},
         {"odd/part.bin", std::string("\0\1\2odd\xFF", 7)},
         {"[Content_Types].xml",
          "<ct:Types xmlns:ct=\"http://schemas.openxmlformats.org/package/2006/content-types\"><ct:Default "
          "Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/><ct:Default "
          "Extension=\"PNG\" ContentType=\"image/png\"/><ct:Override PartName=\"/odd/part.bin\" "
          "ContentType=\"urn:odd\"/></ct:Types>"},
         {"3D/_rels/3dmodel.model.rels",
          "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\"><Relationship "
          "Id=\"t\" Target=\"/3D/Textures/t.png\" Type=\"" +
              texture + "\"/></Relationships>"},
         {"3D/Textures/t.png", "texture"},
         {"3D/Objects/other.model",
          make_model("<m:colorgroup id=\"7\"><m:color color=\"#00FF00\"/></m:colorgroup>" +
                         make_tetrahedron(1, "name=\"far\" p:UUID=\"u-1\" pid=\"7\" pindex=\"0\""),
                     "")},
         {"Metadata/thumbnail.png", "old picture"},
         {"Metadata/plate_1.png", "plate"},
         {"Metadata/model_settings.config", "<config><object id=\"8\"><metadata key=\"extruder\"/></object></config>"},
         {"Metadata/project_settings.config", "{\"layer\": 0.2}"},
         {"Metadata/Slic3r_PE.config", "; layer_height = 0.2\n"}});
}

std::string make_volumetric(const Volumetric& volumetric) {
    Parts parts;
    std::string resources = "<v:image3d id=\"2\"><v:imagestack " + volumetric.stack + ">";
    for (std::size_t k = 0; k < volumetric.sheets.size(); ++k) {
        const std::string path = "3D/v/" + std::to_string(k) + ".png";
        resources += "<v:imagesheet path=\"/" + path + "\"/>";
        if (!volumetric.sheets[k].empty()) parts.emplace_back(path, volumetric.sheets[k]);
    }
    std::string object = make_tetrahedron(1);
    object.replace(object.find("<mesh>"), 6, "<mesh " + volumetric.mesh + ">");
    resources += "</v:imagestack></v:image3d><v:functionfromimage3d id=\"3\" " + volumetric.image_attribute +
                 "=\"2\" " + volumetric.function + "/><v:volumedata id=\"4\">" + volumetric.volume + "</v:volumedata>" +
                 object;
    return make_package(make_model(resources, "<item objectid=\"1\"/>", volumetric.model), parts);
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
