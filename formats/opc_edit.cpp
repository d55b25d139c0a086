#include "formats/opc_edit.h"

#include <algorithm>
#include <map>
#include <set>

#include "formats/lower_case.h"
#include "formats/opc_parts.h"
#include "formats/package_record.h"
#include "formats/xml_spans.h"
#include "formats/xml_text.h"

namespace fretwork {
namespace {

std::string with_slash(const std::string& target) {
    return target.starts_with('/') ? target : "/" + target;
}

/// The element with the blank before it and the end of its line, as `with_relations` writes them.
TextSpan whole_line(std::string_view xml, TextSpan span) {
    if (span.begin > 0 && xml[span.begin - 1] == ' ') --span.begin;
    if (span.end < xml.size() && xml[span.end] == '\n') ++span.end;
    return span;
}

/// A flat document: a root and its children.
class FlatXml {
  public:
    explicit FlatXml(std::string_view text) : text_(text) {
        XmlTagScanner scanner(text);
        while (const auto tag = scanner.next()) {
            if (tags_.empty() || tag->kind != XmlTag::Kind::kEnd) tags_.push_back(*tag);
            last_ = *tag;
        }
    }

    [[nodiscard]] bool empty() const { return tags_.empty(); }

    /// "ct:" when the document spells its namespace so.
    [[nodiscard]] std::string prefix() const { return std::string(tags_.front().prefix()); }

    /// Calls with each child of that name and its attributes.
    template <class Take>
    void each(std::string_view name, const Take& take) const {
        for (std::size_t i = 1; i < tags_.size(); ++i) {
            if (tags_[i].local_name() != name) continue;
            std::map<std::string_view, std::string> values;
            std::vector<XmlAttributeSpan> attributes = attribute_spans(text_, tags_[i]);
            for (const XmlAttributeSpan& a : attributes) values[a.name] = xml_unescaped(a.raw);
            take(values, attributes);
        }
    }

    /// `more` as the last children of the root.
    [[nodiscard]] std::string with_children(const std::string& more) const {
        if (more.empty()) return std::string(text_);
        const XmlTag& root = tags_.front();
        if (root.kind != XmlTag::Kind::kEmpty) return edited(text_, {{{last_.span.begin, last_.span.begin}, more}});
        const std::string closed = ">\n" + more + "</" + std::string(root.name) + ">";
        return edited(text_, {{{root.span.end - 2, root.span.end}, closed}});
    }

  private:
    std::string_view text_;
    std::vector<XmlTag> tags_;  ///< start and empty tags
    XmlTag last_;
};

/// What a [Content_Types].xml says. Names in packages are told apart without regard to case: all are in lower case.
struct ContentTypes {
    std::map<std::string, std::string> by_extension, by_part;

    explicit ContentTypes(const FlatXml& document) {
        document.each("Default", [&](auto& values, auto&) {
            by_extension.emplace(lower_case(values["Extension"]), values["ContentType"]);
        });
        document.each("Override", [&](auto& values, auto&) {
            by_part.emplace(lower_case(values["PartName"]), values["ContentType"]);
        });
    }
};

}  // namespace

std::string with_content_types(std::string_view xml, std::span<const std::string> paths) {
    const FlatXml document(xml);
    if (document.empty()) return std::string(xml);
    ContentTypes types(document);
    std::string more;
    for (const std::string& path : paths) {
        const std::string extension = lower_case(extension_of(path));
        const std::string type(content_type_of(extension));
        if (types.by_part.contains(lower_case(path))) continue;
        const auto [known, added] = types.by_extension.emplace(extension, type);
        if (added)
            more += " <" + document.prefix() + "Default" + xml_attribute("Extension", extension) +
                    xml_attribute("ContentType", type) + "/>\n";
        else if (known->second != type)
            more += " <" + document.prefix() + "Override" + xml_attribute("PartName", path) +
                    xml_attribute("ContentType", type) + "/>\n";
    }
    return document.with_children(more);
}

std::vector<std::string> content_types_of(std::string_view xml, std::span<const std::string> paths) {
    const FlatXml document(xml);
    const ContentTypes types(document);
    std::vector<std::string> found;
    for (const std::string& path : paths) {
        const auto own = types.by_part.find(lower_case(path));
        const auto type = types.by_extension.find(lower_case(extension_of(path)));
        found.push_back(own != types.by_part.end()         ? own->second
                        : type != types.by_extension.end() ? type->second
                                                           : std::string());
    }
    return found;
}

std::string with_relations(std::string_view xml, std::span<const Relation> relations) {
    const FlatXml document(xml);
    if (document.empty()) return relationships_xml({relations.begin(), relations.end()});
    std::set<std::string> ids;
    std::set<std::pair<std::string, std::string>> known;
    document.each("Relationship", [&](auto& values, auto&) {
        ids.insert(values["Id"]);
        known.emplace(lower_case(with_slash(values["Target"])), values["Type"]);
    });
    std::string more;
    std::size_t number = 0;
    for (const auto& [target, type] : relations) {
        if (known.contains({lower_case(target), std::string(type)})) continue;
        std::string id;
        do {
            id = "fretwork" + std::to_string(number++);
        } while (!ids.insert(id).second);
        more += " <" + document.prefix() + "Relationship" + xml_attribute("Id", id) + xml_attribute("Target", target) +
                xml_attribute("Type", type) + "/>\n";
    }
    return document.with_children(more);
}

std::string without_relations_to(std::string_view xml, const std::set<std::string>& targets) {
    std::vector<TextEdit> edits;
    XmlTagScanner scanner(xml);
    while (const auto tag = scanner.next()) {
        if (tag->kind != XmlTag::Kind::kEmpty || tag->local_name() != "Relationship") continue;
        for (const XmlAttributeSpan& attribute : attribute_spans(xml, *tag))
            if (attribute.name == "Target" && targets.contains(lower_case(with_slash(xml_unescaped(attribute.raw)))))
                edits.push_back({whole_line(xml, tag->span), {}});
    }
    return edited(xml, std::move(edits));
}

std::string target_of_relation(std::string_view xml, std::string_view type) {
    std::string target;
    FlatXml(xml).each("Relationship", [&](auto& values, auto&) {
        if (target.empty() && values["Type"] == type && values["TargetMode"] != "External")
            target = with_slash(values["Target"]);
    });
    return target;
}

std::string with_relation_target(std::string_view xml, std::string_view type, std::string_view target) {
    std::vector<TextEdit> edits;
    FlatXml(xml).each("Relationship", [&](auto& values, auto& attributes) {
        if (!edits.empty() || values["Type"] != type) return;
        for (const XmlAttributeSpan& attribute : attributes)
            if (attribute.name == "Target") edits.push_back({attribute.span, xml_attribute("Target", target)});
    });
    return edited(xml, std::move(edits));
}

std::string relations_part_of(std::string_view part) {
    const std::size_t slash = part.rfind('/');
    const std::size_t name = slash == part.npos ? 0 : slash + 1;
    return std::string(part.substr(0, name)) + "_rels/" + std::string(part.substr(name)) + ".rels";
}

}  // namespace fretwork
