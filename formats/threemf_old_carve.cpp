#include "formats/threemf_old_carve.h"

#include <algorithm>
#include <charconv>
#include <map>
#include <utility>

#include "formats/sheet_names.h"
#include "formats/text_scanner.h"
#include "formats/threemf_names.h"

namespace fretwork::threemf {
namespace {

struct Resource {
    std::string name;
    TextSpan span;
    bool own = false;  ///< volume data with a property of ours
    std::vector<std::string> sheets;
};

ResourceId id_of(std::string_view raw) {
    std::int64_t id = 0;
    return parse_integer(xml_unescaped(raw), id) && id > 0 ? static_cast<ResourceId>(id) : 0;
}

std::string_view local_name(std::string_view name) {
    return name.substr(name.find(':') == name.npos ? 0 : name.find(':') + 1);
}

/// Whether an attribute holds the number of a resource, or a list of them. Extensions that are not known are taken to
/// name theirs as all known ones do.
bool is_reference(std::string_view attribute) {
    return attribute != "id" && (attribute.ends_with("id") || attribute.ends_with("ids"));
}

/// Resources by number, and who refers to whom.
class ReferenceScanner {
  public:
    ReferenceScanner(std::string_view xml, const ModelLayout& layout, const std::set<ResourceId>& carved)
        : xml_(xml), layout_(layout), carved_(carved) {}

    void scan() {
        XmlTagScanner scanner(xml_);
        std::size_t depth = 0;
        while (const auto tag = scanner.next()) {
            if (tag->kind != XmlTag::Kind::kEnd) enter(*tag, ++depth);
            if (tag->kind == XmlTag::Kind::kStart) continue;
            if (depth-- == kResourceDepth && resources_.contains(current_)) close(tag->span.end);
        }
    }

    [[nodiscard]] const std::map<ResourceId, Resource>& resources() const { return resources_; }
    [[nodiscard]] const std::set<std::pair<ResourceId, ResourceId>>& references() const { return references_; }
    [[nodiscard]] bool implicit() const { return implicit_; }

  private:
    static constexpr std::size_t kResourceDepth = 3;

    void enter(const XmlTag& tag, std::size_t depth) {
        const std::string_view name = tag.local_name();
        if (name == "vertex" || (name == "triangle" && !triangle_may_refer(tag))) return;
        if (name == "implicitfunction") implicit_ = true;
        const std::vector<XmlAttributeSpan> attributes = attribute_spans(xml_, tag);
        if (depth == kResourceDepth) open(tag, attributes);
        for (const XmlAttributeSpan& attribute : attributes) {
            const std::string_view what = local_name(attribute.name);
            if (is_reference(what))
                refer_to(attribute.raw);
            else if (name == "imagesheet" && what == "path")
                resources_[current_].sheets.push_back(xml_unescaped(attribute.raw));
            else if (name == "property" && what == "name" && is_ours(xml_unescaped(attribute.raw)))
                resources_[current_].own = true;
        }
    }

    /// Those of carved objects go.
    [[nodiscard]] bool triangle_may_refer(const XmlTag& tag) const {
        return !carved_.contains(current_) &&
               xml_.substr(tag.span.begin, tag.span.end - tag.span.begin).find("id") != xml_.npos;
    }

    void refer_to(std::string_view raw) {
        const std::string ids = xml_unescaped(raw);
        const char* const end = ids.data() + ids.size();
        for (const char* at = ids.data(); at < end;) {
            ResourceId id = 0;
            const auto [behind, error] = std::from_chars(at, end, id);
            if (error == std::errc{} && id > 0) references_.emplace(current_, id);
            at = error == std::errc{} ? behind : at + 1;
        }
    }

    void open(const XmlTag& tag, const std::vector<XmlAttributeSpan>& attributes) {
        current_ = 0;
        for (const XmlAttributeSpan& attribute : attributes)
            if (attribute.name == "id") current_ = id_of(attribute.raw);
        resources_[current_].name = tag.local_name();
        resources_[current_].span = tag.span;
    }

    void close(std::size_t end) {
        if (end < xml_.size() && xml_[end] == '\n') ++end;
        resources_[current_].span.end = end;
        current_ = 0;
    }

    [[nodiscard]] bool is_ours(const std::string& property) const {
        const auto space = layout_.declared.find(property.substr(0, std::min(property.find(':'), property.size())));
        return space != layout_.declared.end() && space->second == kFretwork;
    }

    std::string_view xml_;
    const ModelLayout& layout_;
    const std::set<ResourceId>& carved_;
    std::map<ResourceId, Resource> resources_;
    std::set<std::pair<ResourceId, ResourceId>> references_;
    ResourceId current_ = 0;  ///< the resource in hand
    bool implicit_ = false;
};

bool lies_where_ours_do(const Resource& stack) {
    return std::ranges::all_of(stack.sheets, [](const std::string& path) { return stack_suffix_of(path).has_value(); });
}

/// Whether it stands where we write the colours of an object: right before its first image stack.
bool is_before_one_of(const Resource& group, const std::set<ResourceId>& ours,
                      const std::map<ResourceId, Resource>& resources) {
    return std::ranges::any_of(ours, [&](ResourceId id) {
        const auto stack = resources.find(id);
        return stack != resources.end() && stack->second.name == "image3d" &&
               stack->second.span.begin == group.span.end;
    });
}

/// Volume data and colours of the carved objects and what they refer to, as far as it is ours.
std::set<ResourceId> ours_of(const ReferenceScanner& scanner, const std::set<ResourceId>& carved) {
    std::set<ResourceId> ours = carved;
    const auto follow = [&](std::string_view name, const auto& is_own) {
        for (const auto& [from, to] : scanner.references()) {
            const auto found = scanner.resources().find(to);
            if (found != scanner.resources().end() && ours.contains(from) && found->second.name == name &&
                is_own(found->second))
                ours.insert(to);
        }
    };
    follow("volumedata", [](const Resource& volume) { return volume.own; });
    follow("functionfromimage3d", [](const Resource&) { return true; });
    follow("image3d", lies_where_ours_do);
    follow("colorgroup", [&](const Resource& group) { return is_before_one_of(group, ours, scanner.resources()); });
    return ours;
}

}  // namespace

OldCarve old_carve_of(std::string_view xml, const ModelLayout& layout, const std::set<ResourceId>& carved) {
    OldCarve old;
    if (std::ranges::none_of(carved, [&](ResourceId id) { return layout.objects.at(id).volume.has_value(); }))
        return old;
    ReferenceScanner scanner(xml, layout, carved);
    scanner.scan();
    if (scanner.implicit()) return old;
    std::set<ResourceId> dropped = ours_of(scanner, carved);
    // Whatever something that stays refers to stays too, and what that refers to.
    for (bool changed = true; changed;) {
        changed = false;
        for (const auto& [from, to] : scanner.references())
            if (!dropped.contains(from) && !carved.contains(to) && dropped.erase(to) > 0) changed = true;
    }
    for (const ResourceId id : dropped) {
        if (carved.contains(id)) continue;
        const Resource& resource = scanner.resources().at(id);
        old.elements.push_back(resource.span);
        old.ids.insert(id);
        old.sheets.insert(old.sheets.end(), resource.sheets.begin(), resource.sheets.end());
    }
    return old;
}

}  // namespace fretwork::threemf
