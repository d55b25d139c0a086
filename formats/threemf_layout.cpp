#include "formats/threemf_layout.h"

#include <algorithm>

#include "formats/text_scanner.h"
#include "formats/threemf_names.h"

namespace fretwork::threemf {
namespace {

/// Below the children of a mesh nothing is looked at.
constexpr std::size_t kMeshDepth = 4;

class LayoutScanner {
  public:
    explicit LayoutScanner(std::string_view xml) : xml_(xml) {}

    ModelLayout scan() {
        XmlTagScanner scanner(xml_);
        std::size_t depth = 0;  // of the element that the tag belongs to; <model> has 1
        while (const auto tag = scanner.next()) {
            if (tag->kind == XmlTag::Kind::kEnd) {
                if (depth <= kMeshDepth) leave(*tag, depth);
                --depth;
                continue;
            }
            ++depth;
            if (depth <= kMeshDepth + 1) enter(*tag, depth);
            if (tag->kind == XmlTag::Kind::kEmpty) {
                if (depth <= kMeshDepth) leave(*tag, depth);
                --depth;
            }
        }
        return std::move(layout_);
    }

  private:
    struct Level {
        std::string space, name;
        std::map<std::string, std::string> declared;
    };

    void enter(const XmlTag& tag, std::size_t depth) {
        levels_.resize(depth - 1);
        Level& level = levels_.emplace_back();
        const std::vector<XmlAttributeSpan> attributes = attribute_spans(xml_, tag);
        for (const XmlAttributeSpan& attribute : attributes) declare(attribute, level);
        level.space = space_of(tag.prefix());
        level.name = tag.local_name();
        if (depth == 1) {
            layout_.model = tag;
            layout_.declared = level.declared;
        } else if (depth == 2) {
            enter_part(tag, attributes);
        } else if (depth == 3 && levels_[1].name == "resources") {
            enter_resource(tag, attributes);
        } else if (depth == kMeshDepth && level.space == kCore && level.name == "mesh" && place_ != nullptr) {
            enter_mesh(tag, attributes);
        } else if (depth == kMeshDepth + 1 && within_mesh_) {
            if (level.space != kCore || (level.name != "vertices" && level.name != "triangles"))
                place_->beside_triangles.push_back(level.name);
        }
    }

    void leave(const XmlTag& tag, std::size_t depth) {
        if (depth == kMeshDepth && within_mesh_) {
            place_->mesh_content.end = tag.kind == XmlTag::Kind::kEnd ? tag.span.begin : tag.span.end;
            within_mesh_ = false;
        }
        if (depth == 3) place_ = nullptr;
        if (depth == 2 && within_metadata_) {
            layout_.metadata.back().span.end = tag.span.end;
            within_metadata_ = false;
        }
    }

    void declare(const XmlAttributeSpan& attribute, Level& level) {
        if (attribute.name != "xmlns" && !attribute.name.starts_with("xmlns:")) return;
        const std::string prefix(attribute.name.substr(std::min<std::size_t>(6, attribute.name.size())));
        const std::string space = xml_unescaped(attribute.raw);
        level.declared[prefix] = space;
        layout_.spaces[prefix].insert(space);
    }

    /// \param prefix  with its colon; empty for the default namespace
    [[nodiscard]] std::string space_of(std::string_view prefix) const {
        const std::string name(prefix.substr(0, prefix.empty() ? 0 : prefix.size() - 1));
        for (auto level = levels_.rbegin(); level != levels_.rend(); ++level)
            if (const auto found = level->declared.find(name); found != level->declared.end()) return found->second;
        return {};
    }

    void enter_part(const XmlTag& tag, const std::vector<XmlAttributeSpan>& attributes) {
        if (levels_.back().space != kCore) return;
        if (levels_.back().name == "resources") layout_.resources = tag.span.begin;
        if (levels_.back().name != "metadata") return;
        MetadataPlace place;
        place.span = tag.span;
        for (const XmlAttributeSpan& attribute : attributes) {
            if (attribute.name != "name") continue;
            const std::string name = xml_unescaped(attribute.raw);
            const std::size_t colon = name.find(':');
            if (colon != name.npos) place.space = space_of(std::string_view(name).substr(0, colon + 1));
            place.name = colon == name.npos ? name : name.substr(colon + 1);
        }
        layout_.metadata.push_back(std::move(place));
        within_metadata_ = true;
    }

    void enter_resource(const XmlTag& tag, const std::vector<XmlAttributeSpan>& attributes) {
        place_ = nullptr;
        for (const XmlAttributeSpan& attribute : attributes) {
            std::int64_t id = 0;
            if (attribute.name != "id" || !parse_integer(xml_unescaped(attribute.raw), id) || id < 1) continue;
            layout_.ids.insert(static_cast<ResourceId>(id));
            if (levels_.back().space != kCore || levels_.back().name != "object") continue;
            place_ = &layout_.objects[static_cast<ResourceId>(id)];
            place_->object = tag;
        }
        for (const XmlAttributeSpan& attribute : attributes) {
            const std::size_t colon = attribute.name.find(':');
            if (place_ != nullptr && colon != attribute.name.npos &&
                space_of(attribute.name.substr(0, colon + 1)) == kSlice)
                place_->slices.push_back(attribute);
        }
    }

    void enter_mesh(const XmlTag& tag, const std::vector<XmlAttributeSpan>& attributes) {
        within_mesh_ = true;
        place_->mesh = tag;
        place_->mesh_content.begin = tag.span.end;
        for (const XmlAttributeSpan& attribute : attributes) {
            const std::size_t colon = attribute.name.find(':');
            if (colon != attribute.name.npos && attribute.name.substr(colon + 1) == "volumeid" &&
                space_of(attribute.name.substr(0, colon + 1)) == kVolumetric)
                place_->volume = attribute;
        }
    }

    std::string_view xml_;
    ModelLayout layout_;
    std::vector<Level> levels_;
    ObjectPlace* place_ = nullptr;  ///< the object in hand
    bool within_mesh_ = false;
    bool within_metadata_ = false;
};

}  // namespace

ModelLayout layout_of(std::string_view xml) {
    return LayoutScanner(xml).scan();
}

}  // namespace fretwork::threemf
