#include "formats/threemf_model_edit.h"

#include <algorithm>
#include <sstream>

#include "formats/text_scanner.h"
#include "formats/threemf_names.h"
#include "formats/threemf_values.h"
#include "formats/xml_text.h"

namespace fretwork::threemf {
namespace {

/// Text in ASCII alone fits whatever encoding the part declares.
std::string in_ascii(const std::string& xml) {
    std::string out;
    for (std::size_t i = 0; i < xml.size();) {
        const auto lead = static_cast<unsigned char>(xml[i]);
        const std::size_t length = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
        if (length == 1) {
            out += xml[i++];
            continue;
        }
        std::uint32_t code = lead & (0x7Fu >> length);
        for (std::size_t k = 1; k < length; ++k) code = code << 6 | (static_cast<unsigned char>(xml[i + k]) & 0x3Fu);
        out += "&#" + std::to_string(code) + ";";
        i += length;
    }
    return out;
}

bool has_word(const std::string& words, const std::string& word) {
    std::istringstream stream(words);
    for (std::string each; stream >> each;)
        if (each == word) return true;
    return false;
}

}  // namespace

ModelEdit::ModelEdit(std::string_view xml, const ModelLayout& layout, double units_per_mm)
    : xml_(xml), layout_(layout), units_per_mm_(units_per_mm), ids_(layout.ids) {}

/// A prefix that <model> declares, or will, and that means nothing else anywhere in the part.
std::string ModelEdit::prefix_for(std::string_view space, const std::string& wanted) {
    if (const auto known = prefixes_.find(space); known != prefixes_.end()) return known->second;
    std::string prefix;
    for (const auto& [name, meaning] : layout_.declared)
        if (!name.empty() && meaning == space && layout_.spaces.at(name).size() == 1) prefix = name;
    if (prefix.empty()) {
        prefix = wanted;
        const auto taken = [&] {
            return layout_.spaces.contains(prefix) ||
                   std::ranges::any_of(declared_, [&](const auto& d) { return d.first == prefix; });
        };
        for (int number = 2; taken(); ++number) prefix = wanted + std::to_string(number);
        declared_.emplace_back(prefix, space);
    }
    return prefixes_[std::string(space)] = prefix + ":";
}

ModelDialect ModelEdit::dialect_for(const ObjectPlace& place, const CarvedObjectText& carved) {
    ModelDialect dialect;
    dialect.core = place.mesh.prefix();
    dialect.units_per_mm = units_per_mm_;
    const auto recommend = [&](const std::string& prefix) {
        const std::string name = prefix.substr(0, prefix.size() - 1);
        if (std::ranges::find(recommended_, name) == recommended_.end()) recommended_.push_back(name);
    };
    if (carved.colored()) recommend(dialect.material = prefix_for(kMaterial, "m"));
    if (carved.volumetric()) {
        recommend(dialect.volumetric = prefix_for(kVolumetric, "v"));
        dialect.own = prefix_for(kFretwork, "fw");
    }
    const TrianglePaint& paint = carved.object().paint;
    if (paint.format == PaintFormat::kPrusa && !paint.extruders.empty())
        dialect.slicer = prefix_for(kSlic3r, "slic3rpe");
    return dialect;
}

/// Above all that are taken, while there are any; then the lowest that is free.
ResourceId ModelEdit::next_id() {
    ResourceId id = ids_.empty() ? 1 : *ids_.rbegin() + 1;
    if (id > kMaxId)
        for (id = 1; ids_.contains(id);) ++id;
    ids_.insert(id);
    return id;
}

void ModelEdit::set_attribute(const XmlTag& tag, std::string_view name, const std::string& value) {
    const std::string text = xml_attribute(name, value);
    for (const XmlAttributeSpan& attribute : attribute_spans(xml_, tag))
        if (attribute.name == name) {
            changes_.push_back({attribute.span, text, nullptr, {}});
            return;
        }
    const std::size_t end = end_of_attributes(xml_, tag);
    changes_.push_back({{end, end}, text, nullptr, {}});
}

/// Where its colours are among what goes.
void ModelEdit::drop_colors(const XmlTag& object, const std::set<ResourceId>& dropped) {
    const std::vector<XmlAttributeSpan> attributes = attribute_spans(xml_, object);
    const auto pid = std::ranges::find(attributes, "pid", &XmlAttributeSpan::name);
    std::int64_t id = 0;
    if (pid == attributes.end() || !parse_integer(xml_unescaped(pid->raw), id) || id < 0 ||
        !dropped.contains(static_cast<ResourceId>(id)))
        return;
    for (const XmlAttributeSpan& attribute : attributes)
        if (attribute.name == "pid" || attribute.name == "pindex") drop(attribute.span);
}

void ModelEdit::replace_mesh(ResourceId id, CarvedObjectText& carved, const std::set<ResourceId>& dropped) {
    const ObjectPlace& place = layout_.objects.at(id);
    const ModelDialect dialect = dialect_for(place, carved);
    const std::string resources = carved.resources(dialect, [this] { return next_id(); });
    const std::size_t before = place.object.span.begin;
    changes_.push_back({{before, before}, resources, nullptr, {}});
    if (carved.colored()) {
        set_attribute(place.object, "pid", std::to_string(carved.color_group()));
        set_attribute(place.object, "pindex", "0");
    } else {
        drop_colors(place.object, dropped);
    }
    for (const XmlAttributeSpan& slices : place.slices) drop(slices.span);
    if (place.volume) changes_.push_back({place.volume->span, {}, nullptr, {}});
    if (carved.volume() != 0) {
        const std::size_t end = end_of_attributes(xml_, place.mesh);
        changes_.push_back(
            {{end, end}, xml_attribute(dialect.volumetric + "volumeid", std::to_string(carved.volume())), nullptr, {}});
    }
    changes_.push_back({place.mesh_content, {}, &carved, dialect});
}

void ModelEdit::add_metadata(const std::vector<std::pair<std::string, std::string>>& metadata) {
    const std::string open = "<" + std::string(layout_.model.prefix()) + "metadata";
    std::string more;
    for (const auto& [name, value] : metadata) {
        const bool own = name.starts_with("fw:"), slicer = name.starts_with("slic3rpe:");
        const std::string_view space = own ? kFretwork : slicer ? kSlic3r : std::string_view{};
        const std::string local = name.substr(space.empty() ? 0 : name.find(':') + 1);
        const std::string prefix = space.empty() ? "" : prefix_for(space, own ? "fw" : "slic3rpe");
        for (const MetadataPlace& place : layout_.metadata)
            if (place.space == space && place.name == local) changes_.push_back({place.span, {}, nullptr, {}});
        more += open + xml_attribute("name", prefix + local) + ">" + xml_escaped(value) + "</" + open.substr(1) + ">\n";
    }
    changes_.push_back({{layout_.resources, layout_.resources}, in_ascii(more), nullptr, {}});
}

void ModelEdit::change_model_tag() {
    std::string declarations;
    for (const auto& [prefix, space] : declared_) declarations += xml_attribute("xmlns:" + prefix, space);
    const std::size_t end = end_of_attributes(xml_, layout_.model);
    changes_.push_back({{end, end}, declarations, nullptr, {}});

    std::string required, recommended;
    for (const XmlAttributeSpan& attribute : attribute_spans(xml_, layout_.model)) {
        if (attribute.name == "requiredextensions") required = xml_unescaped(attribute.raw);
        if (attribute.name == "recommendedextensions") recommended = xml_unescaped(attribute.raw);
    }
    const std::string before = recommended;
    for (const std::string& prefix : recommended_)
        if (!has_word(required, prefix) && !has_word(recommended, prefix))
            recommended += (recommended.empty() ? "" : " ") + prefix;
    if (recommended != before) set_attribute(layout_.model, "recommendedextensions", recommended);
}

TextPieces ModelEdit::finish() {
    change_model_tag();
    std::ranges::stable_sort(changes_, {}, [](const Change& c) { return std::pair(c.span.begin, c.span.end); });
    TextPieces pieces;
    std::size_t done = 0;
    for (const Change& change : changes_) {
        pieces.add_kept(xml_.substr(done, change.span.begin - done));
        done = change.span.end;
        if (change.mesh != nullptr)
            change.mesh->append_mesh(change.dialect, pieces);
        else
            pieces.add(change.text);
    }
    pieces.add_kept(xml_.substr(done));
    return pieces;
}

}  // namespace fretwork::threemf
