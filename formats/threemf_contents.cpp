#include "formats/threemf_contents.h"

#include <algorithm>
#include <array>
#include <optional>

#include "core/base/error.h"
#include "formats/length_unit.h"
#include "formats/opc_edit.h"
#include "formats/slicer_paint.h"
#include "formats/text_scanner.h"
#include "formats/threemf_materials.h"
#include "formats/threemf_names.h"
#include "formats/xml_reader.h"
#include "formats/zip_reader.h"

namespace fretwork {
namespace {

using threemf::Build;
using threemf::Model;

constexpr std::uint64_t kMaxTextBytes = 8 << 20;
constexpr std::size_t kMostListed = 256;  ///< of extensions, material groups, kinds of elements
constexpr std::size_t kMostEntries = 16;

/// What the model reader steps over, and what it folds into the colours of triangles.
class ModelScanner : public XmlHandler {
  public:
    ModelScanner(std::string part, std::string_view source, ThreemfContents& contents)
        : part_(std::move(part)), xml_(*this, source), contents_(contents) {}

    XmlReader& xml() { return xml_; }

    void start(const XmlElement& e) override {
        ++depth_;
        if (skipped_from_ > 0) return;
        if (depth_ == 1) {
            add_extensions(e.find("requiredextensions").value_or(""), true);
            add_extensions(e.find("recommendedextensions").value_or(""), false);
        } else if (!is_looked_into(e.space)) {
            skipped_from_ = depth_;
            add_carried(e);
        } else if (threemf::Materials::is_group(e)) {
            start_group(e);
        } else if (group_ && depth_ == group_depth_ + 1) {
            add_entry(e);
        } else if (e.name == "triangle") {
            add_paint(e);
        }
    }

    void end() override {
        if (skipped_from_ == depth_) skipped_from_ = 0;
        if (group_ && depth_ == group_depth_) {
            if (contents_.materials.size() < kMostListed) contents_.materials.push_back(std::move(*group_));
            group_.reset();
        }
        --depth_;
    }

    void text(std::string_view) override {}

  private:
    static bool is_looked_into(std::string_view space) {
        return space == threemf::kCore || space == threemf::kMaterial || space == threemf::kVolumetric;
    }

    void add_extensions(std::string_view prefixes, bool required) {
        TextScanner words(prefixes, "", {.comment = 0});
        for (std::string_view prefix = words.word(); !prefix.empty(); prefix = words.word()) {
            const std::string space = xml_.namespace_of(prefix);
            auto& known = contents_.extensions;
            const auto same = std::ranges::find(known, space, &ThreemfExtension::space);
            if (same != known.end())
                same->required = same->required || required;
            else if (known.size() < kMostListed)
                known.push_back({space, required, threemf::is_understood(space)});
        }
    }

    void add_carried(const XmlElement& e) {
        auto& carried = contents_.carried;
        const auto same = std::ranges::find_if(
            carried, [&](const CarriedElements& c) { return c.name == e.name && c.space == e.space; });
        if (same != carried.end())
            ++same->count;
        else if (carried.size() < kMostListed)
            carried.push_back({std::string(e.space), std::string(e.name), 1});
    }

    void start_group(const XmlElement& e) {
        std::int64_t id = 0;
        if (!parse_integer(e.find("id").value_or(""), id)) id = 0;
        group_ = MaterialGroupInfo{part_, static_cast<threemf::ResourceId>(id), std::string(e.name), 0, {}};
        group_depth_ = depth_;
    }

    void add_entry(const XmlElement& e) {
        if (++group_->entries > kMostEntries) return;
        std::string told(e.find("name").value_or(""));
        for (const std::string_view attribute : {"displaycolor", "color"})
            if (const auto color = e.find(attribute)) told.append(told.empty() ? "" : " ").append(*color);
        if (!told.empty()) group_->first.push_back(std::move(told));
    }

    /// Attributes that the format itself gives to a triangle have neither a prefix nor such a name.
    void add_paint(const XmlElement& e) {
        for (const XmlAttribute& a : e.attributes) {
            const bool prusa = a.space == threemf::kSlic3r;
            if (!prusa && !(a.space.empty() && a.name.starts_with("paint_"))) continue;
            std::string name = prusa ? "slic3rpe:" : "";
            name += a.name;
            auto& paint = contents_.paint;
            auto same = std::ranges::find(paint, name, &SlicerPaintInfo::attribute);
            if (same == paint.end()) {
                if (paint.size() >= kMostListed) continue;
                same = paint.insert(paint.end(), SlicerPaintInfo{name, 0, {}});
            }
            ++same->triangles;
            const bool extruders = a.name == "mmu_segmentation" || a.name == "paint_color";
            if (const int extruder = extruders ? extruder_of(a.value) : 0) ++same->extruders[extruder];
        }
    }

    std::string part_;
    XmlReader xml_;
    ThreemfContents& contents_;
    int depth_ = 0;
    int skipped_from_ = 0;  ///< depth of the outermost element that is carried; 0 outside of one
    std::optional<MaterialGroupInfo> group_;
    int group_depth_ = 0;
};

/// Sizes follow from the transform of the property, which takes the object into the unit cube of the stack.
VoxelPropertyInfo voxel_property(const Model& model, const threemf::VolumeProperty& property, double unit_mm) {
    VoxelPropertyInfo info;
    info.name = property.name.empty() ? "color" : property.name;
    const auto function = model.functions.find(property.function);
    if (function == model.functions.end()) return info;
    const auto image = model.images.find(function->second.image);
    if (image == model.images.end()) return info;
    info.columns = image->second.columns;
    info.rows = image->second.rows;
    info.sheets = static_cast<std::int64_t>(image->second.sheets.size());
    const std::array counts = {info.columns, info.rows, info.sheets};
    for (int k = 0; k < 3; ++k)
        info.voxel_mm[k] = unit_mm / (property.transform.linear().row(k).norm() * static_cast<double>(counts[k]));
    return info;
}

void add_voxel_data(const std::string& part, const Model& model, ThreemfContents& contents) {
    for (const auto& [id, object] : model.objects) {
        const auto volume = model.volumes.find(object.volume);
        if (volume == model.volumes.end()) continue;
        VoxelDataInfo info{{part, id}, object.name, {}};
        for (const threemf::VolumeProperty& property : volume->second)
            info.properties.push_back(voxel_property(model, property, millimeters_per(model.unit)));
        contents.voxel_data.push_back(std::move(info));
    }
}

void add_parts(const ZipReader& zip, const Build& build, ThreemfContents& contents) {
    std::set<std::string_view> sheets;
    for (const auto& [part, model] : build.models())
        for (const auto& [id, image] : model.images)
            for (const std::string& sheet : image.sheets) sheets.insert(threemf::without_slash(sheet));
    std::vector<std::string> paths;
    for (const ZipReader::Entry& entry : zip.entries()) {
        if (sheets.contains(entry.name)) {
            ++contents.image_sheets;
            continue;
        }
        contents.parts.push_back({entry.name, "", entry.size});
        paths.push_back("/" + entry.name);
    }
    if (!zip.contains(threemf::kContentTypesPart)) return;
    const std::vector<std::string> types = content_types_of(zip.read(threemf::kContentTypesPart, kMaxTextBytes), paths);
    for (std::size_t i = 0; i < types.size(); ++i) contents.parts[i].content_type = types[i];
}

}  // namespace

ThreemfContents threemf_contents(const Build& build, std::string_view bytes, std::string_view source,
                                 const RunControl& run) {
    const ZipReader zip(bytes, source);
    ThreemfContents contents;
    contents.model_part = build.root_part();
    contents.metadata = build.root().metadata;
    add_parts(zip, build, contents);
    if (zip.contains(threemf::kRootRelationsPart))
        contents.thumbnail = threemf::without_slash(
            target_of_relation(zip.read(threemf::kRootRelationsPart, kMaxTextBytes), threemf::kThumbnailRelation));
    for (const auto& [part, model] : build.models()) {
        ModelScanner scanner(part, source, contents);
        zip.read_blocks(part, [&](std::string_view block) {
            run.throw_if_stopped();
            scanner.xml().feed(block);
        });
        add_voxel_data(part, model, contents);
    }
    return contents;
}

}  // namespace fretwork
