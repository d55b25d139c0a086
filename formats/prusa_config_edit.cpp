#include "formats/prusa_config_edit.h"

#include <vector>

#include "formats/text_scanner.h"
#include "formats/xml_spans.h"
#include "formats/xml_text.h"

namespace fretwork {
namespace {

/// Where a volume stands, and its start tag.
struct VolumePlace {
    threemf::ResourceId object = 0;
    XmlTag tag;
    TextSpan span;
    std::string type = "ModelPart";
};

std::map<std::string_view, std::string> values_of(std::string_view config, const XmlTag& tag) {
    std::map<std::string_view, std::string> values;
    for (const XmlAttributeSpan& attribute : attribute_spans(config, tag))
        values[attribute.name] = xml_unescaped(attribute.raw);
    return values;
}

std::vector<VolumePlace> volumes_of(std::string_view config) {
    std::vector<VolumePlace> volumes;
    XmlTagScanner scanner(config);
    threemf::ResourceId object = 0;
    bool within = false;
    while (const auto tag = scanner.next()) {
        const bool ends = tag->kind == XmlTag::Kind::kEnd;
        if (tag->name == "object" && !ends) {
            std::int64_t id = 0;
            const bool sound = parse_integer(values_of(config, *tag)["id"], id) && id > 0;
            object = sound ? static_cast<threemf::ResourceId>(id) : 0;
        }
        if (tag->name == "metadata" && within && !ends) {
            const auto values = values_of(config, *tag);
            const auto key = values.find("key"), value = values.find("value");
            if (key == values.end() || value == values.end()) continue;
            if (key->second == "volume_type") volumes.back().type = value->second;
            // What versions before 2.0 wrote.
            if (key->second == "modifier" && value->second == "1") volumes.back().type = "ParameterModifier";
        }
        if (tag->name != "volume") continue;
        if (!ends) volumes.push_back({object, *tag, tag->span});
        if (ends && within) volumes.back().span.end = tag->span.end;
        within = tag->kind == XmlTag::Kind::kStart;
    }
    return volumes;
}

}  // namespace

std::string with_carved_volumes(std::string_view config, const std::map<threemf::ResourceId, std::size_t>& triangles) {
    std::vector<TextEdit> edits;
    threemf::ResourceId last = 0;
    for (const VolumePlace& volume : volumes_of(config)) {
        const auto carved = triangles.find(volume.object);
        if (carved == triangles.end()) continue;
        if (volume.object == last) {
            edits.push_back({volume.span, {}});
            continue;
        }
        last = volume.object;
        for (const XmlAttributeSpan& attribute : attribute_spans(config, volume.tag)) {
            if (attribute.name == "firstid") edits.push_back({attribute.span, xml_attribute("firstid", "0")});
            if (attribute.name == "lastid")
                edits.push_back({attribute.span, xml_attribute("lastid", std::to_string(carved->second - 1))});
        }
    }
    return edited(config, std::move(edits));
}

std::map<threemf::ResourceId, std::vector<std::string>> volume_types(std::string_view config) {
    std::map<threemf::ResourceId, std::vector<std::string>> types;
    for (const VolumePlace& volume : volumes_of(config)) types[volume.object].push_back(volume.type);
    return types;
}

}  // namespace fretwork
