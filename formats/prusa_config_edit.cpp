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
};

std::vector<VolumePlace> volumes_of(std::string_view config) {
    std::vector<VolumePlace> volumes;
    XmlTagScanner scanner(config);
    threemf::ResourceId object = 0;
    bool within = false;
    while (const auto tag = scanner.next()) {
        const bool ends = tag->kind == XmlTag::Kind::kEnd;
        if (tag->name == "object" && !ends) {
            object = 0;
            for (const XmlAttributeSpan& attribute : attribute_spans(config, *tag)) {
                std::int64_t id = 0;
                if (attribute.name == "id" && parse_integer(attribute.raw, id) && id > 0)
                    object = static_cast<threemf::ResourceId>(id);
            }
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

std::map<threemf::ResourceId, std::size_t> further_volumes(std::string_view config) {
    std::map<threemf::ResourceId, std::size_t> counts;
    for (const VolumePlace& volume : volumes_of(config)) ++counts[volume.object];
    for (auto& [object, count] : counts) --count;
    return counts;
}

}  // namespace fretwork
