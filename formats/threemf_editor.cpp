#include "formats/threemf_editor.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <map>
#include <set>

#include "core/base/error.h"
#include "formats/lower_case.h"
#include "formats/opc_edit.h"
#include "formats/opc_parts.h"
#include "formats/parse_error.h"
#include "formats/prusa_config_edit.h"
#include "formats/sheet_names.h"
#include "formats/threemf_model_edit.h"
#include "formats/threemf_model_reader.h"
#include "formats/threemf_names.h"
#include "formats/threemf_old_carve.h"
#include "formats/zip_writer.h"

namespace fretwork {
namespace {

using threemf::ModelEdit;
using threemf::ModelLayout;
using threemf::ObjectKey;

constexpr std::uint64_t kMaxEditedBytes = 1 << 30;
constexpr std::uint64_t kMaxSmallPartBytes = 8 << 20;

/// A model part that is changed.
struct EditedPart {
    std::string xml;
    ModelLayout layout;  ///< refers to `xml`
    threemf::OldCarve old_carve;
};

/// What becomes of the parts of an archive: some are replaced, the rest is copied, more follow.
class PartWriter {
  public:
    explicit PartWriter(const ZipReader& from) : from_(from) {}

    void put(std::string_view name, DeflatedPart part) { put_packed(name, {std::move(part), false}); }
    void put(std::string_view name, const std::string& bytes) {
        put(name, deflate_pieces(1, [&](std::size_t) { return bytes; }));
    }
    void put_stored(std::string_view name, std::string bytes) { put_packed(name, {{{std::move(bytes)}, 0, 0}, true}); }

    /// \param names  in lower case; parts that are put all the same are written
    void drop(const std::set<std::string>& names) { dropped_ = names; }

    /// A part as it was; empty when there is none.
    [[nodiscard]] std::string text_of(std::string_view name) const {
        return from_.contains(name) ? xml_as_utf8(from_.read(name, kMaxSmallPartBytes)) : std::string{};
    }

    std::string finish() {
        ZipWriter zip;
        for (const ZipReader::Entry& entry : from_.entries()) {
            const auto changed = changed_.find(lower_case(entry.name));
            if (changed == changed_.end()) {
                if (!dropped_.contains(lower_case(entry.name)))
                    zip.add_packed(entry.name, from_.read_packed(entry.name));
                continue;
            }
            zip.add_packed(entry.name, std::move(changed->second.part));
            changed->second.written = true;
        }
        for (const std::string& name : order_)
            if (Changed& changed = changed_.at(lower_case(name)); !changed.written)
                zip.add_packed(name, std::move(changed.part));
        return zip.finish();
    }

  private:
    struct Changed {
        PackedPart part;
        bool written = false;
    };

    void put_packed(std::string_view name, PackedPart part) {
        order_.emplace_back(name);
        changed_[lower_case(name)].part = std::move(part);
    }

    const ZipReader& from_;
    std::map<std::string, Changed> changed_;
    std::set<std::string> dropped_;
    std::vector<std::string> order_;
};

}  // namespace

struct ThreemfEditor::Impl {
    std::string source;
    threemf::Package package;
    ZipReader zip;
    std::vector<ObjectKey> carved;
    std::map<std::string, EditedPart> parts;
    double unit_mm = 1.0;
    std::vector<std::string> warnings;
    std::set<std::string> old_sheets;  ///< of an earlier carve, in lower case, without the leading slash

    Impl(std::string_view bytes, std::string_view from, const std::vector<ObjectKey>& keys)
        : source(from), package(bytes, from), zip(bytes, from), carved(keys) {
        open_part(package.model_part());
        read_unit(parts.at(package.model_part()));
        for (const ObjectKey& key : keys) {
            open_part(key.part);
            find(key);
        }
        look_at_volumes();
        for (auto& [name, part] : parts) find_old_carve(name, part);
    }

    void find_old_carve(const std::string& name, EditedPart& part) {
        std::set<threemf::ResourceId> here;
        for (const ObjectKey& key : carved)
            if (key.part == name) here.insert(key.id);
        part.old_carve = threemf::old_carve_of(part.xml, part.layout, here);
        for (const std::string& sheet : part.old_carve.sheets) old_sheets.insert(lower_case(sheet.substr(1)));
    }

    void open_part(const std::string& name) {
        if (parts.contains(name)) return;
        EditedPart& part = parts[name];
        part.xml = xml_as_utf8(zip.read(name, kMaxEditedBytes));
        part.layout = threemf::layout_of(part.xml);
    }

    void read_unit(const EditedPart& root) {
        for (const XmlAttributeSpan& attribute : attribute_spans(root.xml, root.layout.model))
            if (attribute.name == "unit")
                unit_mm = millimeters_per(length_unit_from_name(xml_unescaped(attribute.raw)).value());
    }

    void find(const ObjectKey& key) {
        const auto& objects = parts.at(key.part).layout.objects;
        const auto place = objects.find(key.id);
        if (place == objects.end() || place->second.mesh.name.empty())
            fail_parse(source + ": " + key.part, "resources", "no object " + std::to_string(key.id) + " with a mesh",
                       "one");
        if (!place->second.slices.empty())
            warnings.push_back(fmt::format("object {}: its slices show it as it was; it no longer names them", key.id));
        for (const std::string& name : place->second.beside_triangles)
            warnings.push_back(
                fmt::format("object {}: <{}> refers to triangles that are carved away and is left out", key.id, name));
    }

    /// PrusaSlicer puts parts and modifiers of an object into one mesh.
    void look_at_volumes() {
        if (!zip.contains(kPrusaConfigPart)) return;
        const auto volumes = volume_types(zip.read(kPrusaConfigPart, kMaxSmallPartBytes));
        for (const ObjectKey& key : carved) {
            const auto found = volumes.find(key.id);
            if (key.part != package.model_part() || found == volumes.end()) continue;
            for (const std::string& type : found->second)
                if (type != "ModelPart")
                    throw InvalidInput(fmt::format(
                        "{}: object {}: found a volume of PrusaSlicer of type {} in its mesh, expected parts alone; "
                        "carve other objects with --objects, or take it out",
                        source, key.id, type));
            if (found->second.size() > 1)
                warnings.push_back(fmt::format("object {}: its {} volumes of PrusaSlicer are carved as one", key.id,
                                               found->second.size()));
        }
    }

    /// A number behind the names of image stacks, or none, so that no stack of the package has the same name.
    [[nodiscard]] std::string free_suffix(std::size_t& number, bool may_be_empty) const {
        while (true) {
            std::string suffix;
            if (number > 0 || !may_be_empty) suffix = std::to_string(std::max<std::size_t>(number, 1));
            ++number;
            const bool taken = std::ranges::any_of(zip.entries(), [&](const ZipReader::Entry& entry) {
                return !old_sheets.contains(lower_case(entry.name)) && stack_suffix_of("/" + entry.name) == suffix;
            });
            if (!taken) return suffix;
        }
    }
};

namespace {

/// One call of write.
class EditRun {
  public:
    EditRun(const ThreemfEdit& edit, const RunControl& run, const ZipReader& zip)
        : edit_(edit), run_(run), writer_(zip) {}

    PartWriter& writer() { return writer_; }

    void add_texts(const auto& next_suffix) {
        for (const CarvedReplacement& replaced : edit_.objects)
            texts_.emplace_back(replaced.object, next_suffix(), run_);
    }

    void write_model(const std::string& name, const EditedPart& part, double units_per_mm, bool root) {
        ModelEdit model(part.xml, part.layout, units_per_mm);
        std::vector<Relation> sheets;
        bool painted = false;
        for (std::size_t i = 0; i < texts_.size(); ++i) {
            const TrianglePaint& paint = edit_.objects[i].object.paint;
            painted = painted || (paint.format == PaintFormat::kPrusa && !paint.extruders.empty());
            if (edit_.objects[i].key.part != name) continue;
            model.replace_mesh(edit_.objects[i].key.id, texts_[i], part.old_carve.ids);
            add_sheets(texts_[i], sheets);
        }
        for (const TextSpan& old : part.old_carve.elements) model.drop(old);
        if (root) {
            model.add_metadata(metadata_of(edit_.record));
            if (painted) add_slicer_versions(part.layout, model);
        }
        writer_.put(name, model.finish().deflated(run_));
        if (sheets.empty() && part.old_carve.sheets.empty()) return;
        const std::string relations = relations_part_of(name);
        paths_.push_back("/" + relations);
        std::set<std::string> old;
        for (const std::string& sheet : part.old_carve.sheets) old.insert(lower_case(sheet));
        writer_.put(relations, with_relations(without_relations_to(writer_.text_of(relations), old), sheets));
    }

    void write_record(const std::string& package_thumbnail) {
        std::vector<Relation> relations;
        for (const RecordPart& part : parts_of(edit_.record)) {
            writer_.put(part.path.substr(1), part.bytes);
            paths_.push_back(part.path);
            relations.emplace_back(part.path, part.relation);
        }
        std::string roots = writer_.text_of(threemf::kRootRelationsPart);
        if (!edit_.record.thumbnail_png.empty()) {
            const bool is_png = lower_case(package_thumbnail).ends_with(".png");
            const std::string path = is_png ? package_thumbnail : "/Metadata/thumbnail.png";
            if (package_thumbnail.empty())
                relations.emplace_back(path, threemf::kThumbnailRelation);
            else if (!is_png)
                roots = with_relation_target(roots, threemf::kThumbnailRelation, path);
            writer_.put_stored(path.substr(1), edit_.record.thumbnail_png);
            paths_.push_back(path);
        }
        if (roots.empty())
            relations.emplace_back(std::string("/").append(threemf::kModelPart), threemf::kModelRelation);
        writer_.put(threemf::kRootRelationsPart, with_relations(roots, relations));
    }

    void write_types() {
        for (const std::string_view part : {threemf::kModelPart, threemf::kRootRelationsPart})
            paths_.push_back(std::string("/").append(part));
        const std::string types = writer_.text_of(threemf::kContentTypesPart);
        writer_.put(threemf::kContentTypesPart,
                    with_content_types(types.empty() ? content_types_xml({}) : types, paths_));
    }

    void write_slicer_config(const std::string& root) {
        const std::string config = writer_.text_of(kPrusaConfigPart);
        std::map<threemf::ResourceId, std::size_t> triangles;
        for (const CarvedReplacement& replaced : edit_.objects)
            if (replaced.key.part == root) triangles[replaced.key.id] = replaced.object.mesh.triangles.size();
        if (const std::string changed = with_carved_volumes(config, triangles); changed != config)
            writer_.put(kPrusaConfigPart, changed);
    }

  private:
    /// Where a slicer has noted its own, those stay.
    static void add_slicer_versions(const ModelLayout& layout, ModelEdit& model) {
        for (const std::string_view version : threemf::kSlic3rVersions) {
            const std::string_view name = version.substr(version.find(':') + 1);
            const bool noted = std::ranges::any_of(layout.metadata, [&](const threemf::MetadataPlace& place) {
                return place.space == threemf::kSlic3r && place.name == name;
            });
            if (!noted) model.add_metadata({{std::string(version), "1"}});
        }
    }

    void add_sheets(const CarvedObjectText& text, std::vector<Relation>& relations) {
        for (auto& [path, png] : text.sheets()) {
            writer_.put_stored(path.substr(1), png);
            paths_.push_back(path);
            relations.emplace_back(path, threemf::kTextureRelation);
        }
    }

    const ThreemfEdit& edit_;
    const RunControl& run_;
    PartWriter writer_;
    std::deque<CarvedObjectText> texts_;
    std::vector<std::string> paths_;  ///< of what is written, for the content types
};

}  // namespace

ThreemfEditor::ThreemfEditor(std::string_view bytes, std::string_view source, const std::vector<ObjectKey>& carved)
    : impl_(std::make_unique<Impl>(bytes, source, carved)) {}
ThreemfEditor::~ThreemfEditor() = default;

const std::vector<std::string>& ThreemfEditor::warnings() const {
    return impl_->warnings;
}

std::string ThreemfEditor::write(const ThreemfEdit& edit, const RunControl& run) const {
    if (!std::ranges::equal(edit.objects, impl_->carved, {}, &CarvedReplacement::key))
        throw InvalidInput("write 3mf: found other objects than those that were to be carved");
    EditRun writing(edit, run, impl_->zip);
    writing.writer().drop(impl_->old_sheets);
    std::size_t number = edit.objects.size() > 1 ? 1 : 0;
    const bool single = edit.objects.size() == 1;
    writing.add_texts([&] { return impl_->free_suffix(number, single); });
    run.checkpoint("write 3mf", 0.3);
    const std::string& root = impl_->package.model_part();
    for (const auto& [name, part] : impl_->parts) writing.write_model(name, part, 1.0 / impl_->unit_mm, name == root);
    run.checkpoint("write 3mf", 0.8);
    const std::string roots = writing.writer().text_of(threemf::kRootRelationsPart);
    writing.write_record(target_of_relation(roots, threemf::kThumbnailRelation));
    writing.write_slicer_config(root);
    writing.write_types();
    std::string bytes = writing.writer().finish();
    run.checkpoint("write 3mf", 1.0);
    return bytes;
}

}  // namespace fretwork
