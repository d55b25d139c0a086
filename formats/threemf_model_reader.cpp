#include "formats/threemf_model_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>

#include "formats/color_channel.h"
#include "formats/mesh_data.h"
#include "formats/parse_error.h"
#include "formats/plain_elements.h"
#include "formats/text_scanner.h"
#include "formats/threemf_names.h"
#include "formats/threemf_values.h"
#include "formats/xml_reader.h"

namespace fretwork::threemf {
namespace {

constexpr std::size_t kMaxItems = 1 << 16;  ///< of objects, components, build items, metadata, colour tables
constexpr std::size_t kMaxTextBytes = 1 << 20;
constexpr std::size_t kLongestSpace = 200;  ///< of a namespace in a message
constexpr std::size_t kStopEvery = 1 << 14;

/// Where in the document we are; kSkip stands for anything that is not read, with all it holds.
enum class Within {
    kNothing,
    kSkip,
    kModel,
    kMetadata,
    kResources,
    kMaterialGroup,
    kObject,
    kMesh,
    kVertices,
    kTriangles,
    kComponents,
    kBuild,
    kImage3d,
    kImageStack,
    kVolumeData,
    kLeaf,  ///< read, and holds nothing that matters
};

}  // namespace

class ModelReader::Handler : public XmlHandler {
  public:
    Handler(std::string_view source, const ModelReadOptions& options, const RunControl& run)
        : xml_(*this, source),
          ignore_required_(options.ignore_required),
          run_(run),
          materials_(xml_, options.read_part) {}

    XmlReader& xml() { return xml_; }

    /// Vertices or triangles may come next.
    [[nodiscard]] bool within_plain() const {
        return !within_.empty() && (within_.back() == Within::kVertices || within_.back() == Within::kTriangles) &&
               plain_children_ && xml_.at_content();
    }

    /// Takes those that stand plainly off the front of the text. \return how much that is
    std::size_t take_plain(std::string_view text) {
        if (!within_plain()) return 0;
        PlainElements elements(text);
        std::size_t lines = 0;
        const auto count_lines = [&] {
            xml_.skip_lines(elements.lines() - lines);
            lines = elements.lines();
        };
        if (within_.back() == Within::kVertices) {
            while (const auto vertex = elements.vertex()) push_vertex(*vertex);
        } else {
            while (const auto triangle = elements.triangle()) {
                count_lines();
                push_triangle(*triangle);
            }
        }
        count_lines();
        return text.size() - elements.rest().size();
    }

    Model take() {
        if (!model_seen_) xml_.fail("no model", "a <model> of the core namespace");
        if (degenerate_triangles_ > 0)
            model_.warnings.push_back(std::to_string(degenerate_triangles_) +
                                      " triangles that name one vertex twice were dropped");
        if (skipped_properties_ > 0)
            model_.warnings.push_back(std::to_string(skipped_properties_) +
                                      " triangles with properties that are not colours");
        model_.warnings.insert(model_.warnings.end(), materials_.warnings().begin(), materials_.warnings().end());
        return std::move(model_);
    }

    void start(const XmlElement& element) override {
        const Within parent = within_.empty() ? Within::kNothing : within_.back();
        within_.push_back(enter(parent, element));
    }

    void end() override {
        switch (within_.back()) {
            case Within::kMetadata:
                model_.metadata.emplace_back(std::move(metadata_name_), std::move(text_));
                text_.clear();
                break;
            case Within::kMesh:
                check_triangles();
                break;
            case Within::kImageStack:
                if (image_->sheets.size() != sheets_wanted_)
                    xml_.fail(std::to_string(image_->sheets.size()) + " sheets",
                              "the " + std::to_string(sheets_wanted_) + " announced");
                break;
            default:
                break;
        }
        within_.pop_back();
    }

    void text(std::string_view characters) override {
        if (within_.empty() || within_.back() != Within::kMetadata) return;
        if (text_.size() + characters.size() > kMaxTextBytes) xml_.fail("metadata over 1 MiB", "a shorter text");
        text_.append(characters);
    }

  private:
    Within enter(Within parent, const XmlElement& e) {
        if (parent == Within::kNothing) return enter_model(e);
        if (e.space == kCore) return enter_core(parent, e);
        if (e.space == kMaterial) return enter_material(parent, e);
        if (e.space == kVolumetric) return enter_volumetric(parent, e);
        return Within::kSkip;
    }

    Within enter_core(Within parent, const XmlElement& e) {
        switch (parent) {
            case Within::kModel:
                if (e.name == "resources") return Within::kResources;
                if (e.name == "build") return Within::kBuild;
                if (e.name == "metadata") return start_metadata(e);
                break;
            case Within::kResources:
                if (e.name == "object") return start_object(e);
                if (Materials::is_group(e)) return start_group(e);
                break;
            case Within::kMaterialGroup:
                return add_material(e);
            case Within::kObject:
                if (e.name == "mesh") return start_mesh(e);
                if (e.name == "components") return Within::kComponents;
                break;
            case Within::kMesh:
                plain_children_ = e.prefix.empty();
                if (e.name == "vertices") return Within::kVertices;
                if (e.name == "triangles") return Within::kTriangles;
                break;
            case Within::kVertices:
                if (e.name == "vertex") return add_vertex(e);
                break;
            case Within::kTriangles:
                if (e.name == "triangle") return add_triangle(e);
                break;
            case Within::kComponents:
                if (e.name == "component") return add_instance(e, object_->components, "components");
                break;
            case Within::kBuild:
                if (e.name == "item") return add_instance(e, model_.items, "build items");
                break;
            default:
                break;
        }
        return Within::kSkip;
    }

    Within enter_material(Within parent, const XmlElement& e) {
        if (parent == Within::kResources && Materials::is_group(e)) return start_group(e);
        if (parent == Within::kMaterialGroup) return add_material(e);
        if (parent != Within::kResources || e.name != "texture2d") return Within::kSkip;
        materials_.add_texture(e, new_id(e));
        return Within::kLeaf;
    }

    Within enter_volumetric(Within parent, const XmlElement& e) {
        if (parent == Within::kResources && e.name == "image3d") return start_image(e);
        if (parent == Within::kImage3d && e.name == "imagestack") return start_stack(e);
        if (parent == Within::kImageStack && e.name == "imagesheet") return add_sheet(e);
        if (parent == Within::kResources && e.name == "functionfromimage3d") return add_function(e);
        if (parent == Within::kResources && e.name == "volumedata") {
            volume_ = &model_.volumes[new_id(e)];
            return Within::kVolumeData;
        }
        if (parent == Within::kVolumeData && (e.name == "color" || e.name == "property")) return add_property(e);
        return Within::kSkip;
    }

    Within enter_model(const XmlElement& e) {
        if (e.name != "model" || e.space != kCore)
            xml_.fail("element " + in_quotes(e.name), "a <model> of the core namespace");
        model_seen_ = true;
        if (const auto unit = e.find("unit")) {
            const auto known = length_unit_from_name(*unit);
            if (!known) xml_.fail("unit " + in_quotes(*unit), "micron, millimeter, centimeter, inch, foot or meter");
            model_.unit = *known;
        }
        check_required(e.find("requiredextensions").value_or(""));
        return Within::kModel;
    }

    void check_required(std::string_view prefixes) {
        TextScanner words(prefixes, "", {.comment = 0});
        for (std::string_view prefix = words.word(); !prefix.empty(); prefix = words.word()) {
            const std::string space = xml_.namespace_of(prefix);
            if (is_understood(space)) continue;
            const std::string name(name_of_carried(space));
            const std::string found = "the required extension " + in_quotes(prefix) + " (" +
                                      (name.empty() ? "" : name + ", ") + in_quotes(space, kLongestSpace) + ")";
            if (!ignore_required_)
                xml_.fail(found, "core, materials, production, triangle sets or volumetric; --ignore-required goes on");
            model_.warnings.push_back(found + " is not understood");
        }
    }

    ResourceId new_id(const XmlElement& e) {
        const ResourceId id = values_.id(e, "id");
        if (!ids_.insert(id).second)
            xml_.fail("a second resource with id " + std::to_string(id), "ids without repeats");
        if (ids_.size() > kMaxItems) xml_.fail("over 65536 resources", "fewer");
        return id;
    }

    Within start_metadata(const XmlElement& e) {
        metadata_name_ = e.find("name").value_or("");
        if (model_.metadata.size() >= kMaxItems) xml_.fail("over 65536 metadata", "fewer");
        return Within::kMetadata;
    }

    Within start_group(const XmlElement& e) {
        materials_.start_group(e, new_id(e));
        return Within::kMaterialGroup;
    }

    Within add_material(const XmlElement& e) {
        materials_.add_entry(e);
        return Within::kLeaf;
    }

    Within start_object(const XmlElement& e) {
        const ResourceId id = new_id(e);
        object_ = &model_.objects[id];
        object_->line = xml_.line();
        object_->name = e.find("name").value_or("");
        object_->type = e.find("type").value_or("model");
        object_->part_number = e.find("partnumber").value_or("");
        default_color_ = std::nullopt;
        object_group_ = e.find("pid") ? values_.id(e, "pid") : 0;
        if (object_group_ != 0) {
            const std::int64_t index = values_.whole(e.find("pindex").value_or("0"), "pindex", 0, kMaxId);
            default_color_ = materials_.color_of(object_group_, {index, index, index});
        }
        return Within::kObject;
    }

    Within start_mesh(const XmlElement& e) {
        if (!object_->mesh.positions_mm.empty()) xml_.fail("a second mesh in one object", "one");
        if (const auto volume = e.find("volumeid", kVolumetric))
            object_->volume = static_cast<ResourceId>(values_.whole(*volume, "volumeid", 1, kMaxId));
        colored_ = false;
        last_group_ = 0;
        return Within::kMesh;
    }

    Within add_vertex(const XmlElement& e) {
        push_vertex({values_.number(values_.need(e, "x"), "x"), values_.number(values_.need(e, "y"), "y"),
                     values_.number(values_.need(e, "z"), "z")});
        return Within::kLeaf;
    }

    void push_vertex(const Vec3& p) {
        auto& positions = object_->mesh.positions_mm;
        if (positions.size() % kStopEvery == 0) run_.throw_if_stopped();
        positions.push_back(p);
    }

    Within add_triangle(const XmlElement& e) {
        TriangleElement triangle;
        static constexpr std::array<std::string_view, 3> kCorners = {"v1", "v2", "v3"};
        for (std::size_t k = 0; k < 3; ++k)
            triangle.corners[k] = static_cast<std::uint32_t>(
                values_.whole(values_.need(e, kCorners[k]), kCorners[k], 0, kMaxVertexIndex));
        if (e.find("pid")) triangle.group = values_.id(e, "pid");
        for (const std::string_view name : {"p1", "p2", "p3"}) {
            const auto value = e.find(name);
            if (!value) break;
            triangle.property[triangle.properties++] = values_.whole(*value, name, 0, kMaxId);
        }
        push_triangle(triangle);
        return Within::kLeaf;
    }

    void push_triangle(const TriangleElement& triangle) {
        TriangleMesh& mesh = object_->mesh;
        if (mesh.triangles.size() % kStopEvery == 0) run_.throw_if_stopped();
        const Triangle& v = triangle.corners;
        // Forbidden by the format, yet common; such a triangle has no area and nothing to carve.
        if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) {
            ++degenerate_triangles_;
            return;
        }
        mesh.triangles.push_back(v);
        add_triangle_color(triangle_color(triangle));
    }

    void add_triangle_color(const std::optional<Rgb8>& color) {
        auto& colors = object_->triangle_colors;
        if (color && !colored_) {
            colored_ = true;
            colors.assign(object_->mesh.triangles.size() - 1, kUncolored);
        }
        if (colored_) colors.push_back(color.value_or(kUncolored));
    }

    /// The object's own colour where the triangle has none.
    std::optional<Rgb8> triangle_color(const TriangleElement& triangle) {
        const ResourceId group = triangle.group != 0 ? triangle.group : object_group_;
        if (group == 0 || triangle.properties == 0) return default_color_;
        const auto& [p1, p2, p3] = triangle.property;
        const std::array<std::int64_t, 3> corners = {p1, triangle.properties == 3 ? p2 : p1,
                                                     triangle.properties == 3 ? p3 : p1};
        // Neighbours mostly have one colour.
        if (group != last_group_ || corners != last_corners_) {
            last_color_ = materials_.color_of(group, corners);
            last_group_ = group;
            last_corners_ = corners;
        }
        if (!last_color_) ++skipped_properties_;
        return last_color_ ? last_color_ : default_color_;
    }

    /// Triangles may come before the vertices in the text, so indices are judged at the end.
    void check_triangles() const {
        const TriangleMesh& mesh = object_->mesh;
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
            for (const std::uint32_t v : mesh.triangles[t])
                if (v >= mesh.positions_mm.size())
                    xml_.fail("vertex index " + std::to_string(v) + " in triangle " + std::to_string(t),
                              "one below " + std::to_string(mesh.positions_mm.size()));
    }

    Within add_instance(const XmlElement& e, std::vector<Instance>& to, std::string_view what) {
        if (to.size() >= kMaxItems) xml_.fail("over 65536 " + std::string(what), "fewer");
        Instance instance;
        instance.object = values_.id(e, "objectid");
        instance.part = e.find("path", kProduction).value_or("");
        instance.line = xml_.line();
        if (const auto transform = e.find("transform")) instance.transform = values_.transform(*transform);
        const std::string_view printable = e.find("printable").value_or("1");
        instance.printable = printable != "0" && printable != "false";
        to.push_back(std::move(instance));
        return Within::kLeaf;
    }

    Within start_image(const XmlElement& e) {
        image_ = &model_.images[new_id(e)];
        image_->name = e.find("name").value_or("");
        return Within::kImage3d;
    }

    Within start_stack(const XmlElement& e) {
        constexpr std::int64_t kMost = 1024;
        image_->rows = values_.whole(values_.need(e, "rowcount"), "rowcount", 1, kMost);
        image_->columns = values_.whole(values_.need(e, "columncount"), "columncount", 1, kMost);
        sheets_wanted_ = static_cast<std::size_t>(values_.whole(values_.need(e, "sheetcount"), "sheetcount", 1, kMost));
        return Within::kImageStack;
    }

    Within add_sheet(const XmlElement& e) {
        if (image_->sheets.size() >= sheets_wanted_)
            xml_.fail("more sheets than the " + std::to_string(sheets_wanted_) + " announced", "that number");
        image_->sheets.emplace_back(values_.need(e, "path"));
        return Within::kLeaf;
    }

    /// Examples of the specification spell some names as its drafts did, and files that follow them are about.
    Within add_function(const XmlElement& e) {
        const auto number = [&](std::string_view name, std::string_view old_name, std::string_view otherwise) {
            return values_.number(e.find(name).value_or(e.find(old_name).value_or(otherwise)), name);
        };
        ImageFunction& function = model_.functions[new_id(e)];
        function.image = values_.id(e, e.find("image3did") ? "image3did" : "image3dID");
        function.offset = number("valueoffset", "offset", "0");
        function.scale = number("valuescale", "scale", "1");
        const std::string_view filter = e.find("filter").value_or("linear");
        if (filter != "linear" && filter != "nearest") xml_.fail("filter " + in_quotes(filter), "linear or nearest");
        function.nearest = filter == "nearest";
        function.tile[0] = values_.tile_style(e, "tilestyleu");
        function.tile[1] = values_.tile_style(e, "tilestylev");
        function.tile[2] = values_.tile_style(e, "tilestylew");
        return Within::kLeaf;
    }

    Within add_property(const XmlElement& e) {
        if (volume_->size() >= 256) xml_.fail("over 256 properties", "fewer");
        VolumeProperty property;
        if (e.name == "property") property.name = values_.need(e, "name");
        property.function = values_.id(e, "functionid");
        property.channel = values_.need(e, "channel");
        if (const auto transform = e.find("transform")) property.transform = values_.transform(*transform);
        volume_->push_back(std::move(property));
        return Within::kLeaf;
    }

    XmlReader xml_;
    ThreemfValues values_{xml_};
    bool ignore_required_;
    const RunControl& run_;
    Materials materials_;
    Model model_;
    std::vector<Within> within_;
    std::set<ResourceId> ids_;
    std::string metadata_name_, text_;
    // What is being filled; map nodes do not move.
    Object* object_ = nullptr;
    Image3d* image_ = nullptr;
    std::vector<VolumeProperty>* volume_ = nullptr;
    ResourceId object_group_ = 0;
    std::optional<Rgb8> default_color_;
    bool colored_ = false;
    ResourceId last_group_ = 0;  ///< of the last triangle with properties, what it named and what that looks like
    std::array<std::int64_t, 3> last_corners_{};
    std::optional<Rgb8> last_color_;
    bool plain_children_ = false;  ///< elements without a prefix are of the core namespace
    bool model_seen_ = false;
    std::size_t sheets_wanted_ = 0;
    std::size_t skipped_properties_ = 0;
    std::size_t degenerate_triangles_ = 0;
};

ModelReader::ModelReader(std::string_view source, const ModelReadOptions& options, const RunControl& run)
    : handler_(std::make_unique<Handler>(source, options, run)) {}
ModelReader::~ModelReader() = default;

namespace {

/// A tag that goes on longer than this is no plain one.
constexpr std::size_t kMostKept = 1 << 12;

/// Where the first tag ends behind which plain elements may begin; 0 where there is none.
std::size_t end_of_opening(std::string_view text) {
    constexpr std::string_view kEnd = "s>";
    for (std::size_t at = text.find(kEnd); at != text.npos; at = text.find(kEnd, at + 1)) {
        const std::string_view until = text.substr(0, at + kEnd.size());
        if (until.ends_with("<vertices>") || until.ends_with("<triangles>")) return until.size();
    }
    return 0;
}

/// How much of a text the XML reader is to be given before plain elements are looked for anew; 0 where the text ends
/// within a tag. A `>` that does not end one only has it asked sooner or later. \param one_tag  plain elements may
/// follow right behind the next tag
std::size_t next_piece(std::string_view text, bool one_tag) {
    if (one_tag) return text.find('>') + 1;
    const std::size_t opening = end_of_opening(text);
    return opening > 0 ? opening : text.rfind('>') + 1;
}

}  // namespace

void ModelReader::feed(std::string_view block) {
    std::string joined;
    std::string_view text = block;
    if (!rest_.empty()) {
        joined = std::move(rest_).append(block);
        rest_.clear();
        text = joined;
    }
    while (!text.empty()) {
        const std::size_t plain = handler_->take_plain(text);
        text.remove_prefix(plain);
        std::size_t piece = next_piece(text, handler_->within_plain());
        if (piece == 0 && text.size() < kMostKept) break;
        if (piece == 0) piece = text.size();
        handler_->xml().feed(text.substr(0, piece));
        text.remove_prefix(piece);
    }
    rest_ = text;
}

Model ModelReader::finish() {
    if (!rest_.empty()) handler_->xml().feed(rest_);
    handler_->xml().finish();
    return handler_->take();
}

Model read_model(std::string_view xml, std::string_view source, const RunControl& run) {
    ModelReader reader(source, {}, run);
    reader.feed(xml);
    return reader.finish();
}

}  // namespace fretwork::threemf
