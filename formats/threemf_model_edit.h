// One model part with carved objects.
#pragma once

#include <deque>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "formats/carved_object_text.h"
#include "formats/text_pieces.h"
#include "formats/threemf_layout.h"

namespace fretwork::threemf {

/// The text with the carved objects in it. Texts and objects must outlive what it makes.
class ModelEdit {
  public:
    ModelEdit(std::string_view xml, const ModelLayout& layout, double units_per_mm);

    /// \param dropped  resources that go: an object that is left without colours no longer names them
    void replace_mesh(ResourceId id, CarvedObjectText& carved, const std::set<ResourceId>& dropped);

    /// Leaves out what stands there.
    void drop(const TextSpan& span) { changes_.push_back({span, {}, nullptr, {}}); }

    /// Names of the core specification, or those that start with "fw:" or "slic3rpe:"; one of the same name is
    /// replaced.
    void add_metadata(const std::vector<std::pair<std::string, std::string>>& metadata);

    /// Call once, last.
    TextPieces finish();

  private:
    /// Text in the place of a stretch, or a carved mesh.
    struct Change {
        TextSpan span;
        std::string text;
        const CarvedObjectText* mesh = nullptr;
        ModelDialect dialect;
    };

    std::string prefix_for(std::string_view space, const std::string& wanted);
    ModelDialect dialect_for(const ObjectPlace& place, const CarvedObjectText& carved);
    ResourceId next_id();
    void set_attribute(const XmlTag& tag, std::string_view name, const std::string& value);
    void drop_colors(const XmlTag& object, const std::set<ResourceId>& dropped);
    void change_model_tag();

    std::string_view xml_;
    const ModelLayout& layout_;
    double units_per_mm_;
    std::set<ResourceId> ids_;
    std::map<std::string, std::string, std::less<>> prefixes_;   ///< namespace -> prefix with its colon
    std::vector<std::pair<std::string, std::string>> declared_;  ///< prefix and namespace, to be declared
    std::vector<std::string> recommended_;
    std::vector<Change> changes_;
};

}  // namespace fretwork::threemf
