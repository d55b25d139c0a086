#include "formats/opc_parts.h"

#include "formats/xml_text.h"

namespace fretwork {

std::string content_types_xml(const std::vector<std::pair<std::string_view, std::string_view>>& types) {
    std::string xml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n";
    for (const auto& [extension, type] : types)
        xml += " <Default" + xml_attribute("Extension", extension) + xml_attribute("ContentType", type) + "/>\n";
    return xml + "</Types>\n";
}

std::string relationships_xml(const std::vector<std::pair<std::string, std::string_view>>& targets) {
    std::string xml =
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n";
    for (std::size_t i = 0; i < targets.size(); ++i)
        xml += " <Relationship" + xml_attribute("Id", "rel" + std::to_string(i)) +
               xml_attribute("Target", targets[i].first) + xml_attribute("Type", targets[i].second) + "/>\n";
    return xml + "</Relationships>\n";
}

}  // namespace fretwork
