#include "formats/carved_threemf_writer.h"

#include <algorithm>
#include <array>
#include <deque>

#include "core/base/error.h"
#include "formats/atomic_write.h"
#include "formats/carved_object_text.h"
#include "formats/opc_parts.h"
#include "formats/threemf_names.h"
#include "formats/xml_text.h"
#include "formats/zip_writer.h"

namespace fretwork {
namespace {

class PackageWriter {
  public:
    PackageWriter(const CarvedPackage& package, const RunControl& run) : package_(package), run_(run) {}

    std::string write() {
        check();
        for (std::size_t i = 0; i < package_.objects.size(); ++i)
            texts_.emplace_back(package_.objects[i], package_.objects.size() > 1 ? std::to_string(i + 1) : "", run_);
        run_.checkpoint("write 3mf", 0.3);
        ZipWriter zip;
        const std::vector<RecordPart> parts = parts_of(package_);
        zip.add(threemf::kContentTypesPart, content_types(parts));
        zip.add(threemf::kRootRelationsPart, root_relations(parts));
        zip.add_deflated(threemf::kModelPart, model());
        run_.checkpoint("write 3mf", 0.8);
        add_sheets(zip);
        for (const RecordPart& part : parts) zip.add(part.path.substr(1), part.bytes);
        if (!package_.thumbnail_png.empty()) zip.add_stored("Metadata/thumbnail.png", package_.thumbnail_png);
        std::string bytes = zip.finish();
        run_.checkpoint("write 3mf", 1.0);
        return bytes;
    }

  private:
    void check() const {
        if (package_.objects.empty()) throw InvalidInput("write 3mf: found no object, expected at least one");
        static constexpr std::array<std::string_view, 9> kKnown = {"Title",        "Designer",         "Description",
                                                                   "Copyright",    "LicenseTerms",     "Rating",
                                                                   "CreationDate", "ModificationDate", "Application"};
        for (const auto& [name, value] : package_.metadata)
            if (!name.starts_with("fw:") && std::ranges::find(kKnown, name) == kKnown.end())
                throw InvalidInput("write 3mf: metadata: found the name \"" + name +
                                   "\", expected one of the core specification or one that starts with fw:");
    }

    static std::string content_types(const std::vector<RecordPart>& parts) {
        std::vector<std::string_view> extensions = {"rels", "model", "png", "toml", "json"};
        for (const RecordPart& part : parts)
            if (const auto extension = extension_of(part.path);
                std::ranges::find(extensions, extension) == extensions.end())
                extensions.push_back(extension);
        std::vector<std::pair<std::string_view, std::string_view>> types;
        for (const std::string_view extension : extensions) types.emplace_back(extension, content_type_of(extension));
        return content_types_xml(types);
    }

    [[nodiscard]] std::string root_relations(const std::vector<RecordPart>& parts) const {
        std::vector<std::pair<std::string, std::string_view>> targets = {
            {"/" + std::string(threemf::kModelPart), threemf::kModelRelation}};
        if (!package_.thumbnail_png.empty())
            targets.emplace_back("/Metadata/thumbnail.png", threemf::kThumbnailRelation);
        for (const RecordPart& part : parts) targets.emplace_back(part.path, part.relation);
        return relationships_xml(targets);
    }

    void add_sheets(ZipWriter& zip) const {
        std::vector<std::pair<std::string, std::string_view>> targets;
        for (const CarvedObjectText& text : texts_)
            for (auto& [path, png] : text.sheets()) {
                zip.add_stored(path.substr(1), png);
                targets.emplace_back(path, threemf::kTextureRelation);
            }
        if (!targets.empty()) zip.add(threemf::kModelRelationsPart, relationships_xml(targets));
    }

    DeflatedPart model() {
        const auto next_id = [this] { return next_id_++; };
        TextPieces pieces;
        pieces.add(model_head());
        std::string items;
        for (CarvedObjectText& text : texts_) {
            pieces.add(text.resources(dialect_, next_id));
            const std::string id = std::to_string(next_id());
            pieces.add(object_head(text, id));
            text.append_mesh(dialect_, pieces);
            pieces.add("</mesh></object>\n");
            items += "<item" + xml_attribute("objectid", id) + "/>\n";
        }
        pieces.add("</resources>\n<build>\n" + items + "</build>\n</model>\n");
        return pieces.deflated(run_);
    }

    [[nodiscard]] bool painted(PaintFormat format) const {
        return std::ranges::any_of(package_.objects, [&](const CarvedObject& object) {
            return object.paint.format == format && !object.paint.extruders.empty();
        });
    }

    [[nodiscard]] std::string model_head() const {
        std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\"";
        const bool colored = std::ranges::any_of(texts_, &CarvedObjectText::colored);
        const bool volumetric = std::ranges::any_of(texts_, &CarvedObjectText::volumetric);
        if (colored || volumetric)
            xml += xml_attribute("recommendedextensions", !volumetric ? "m" : !colored ? "v" : "m v");
        xml += xml_attribute("xmlns", threemf::kCore) + xml_attribute("xmlns:m", threemf::kMaterial) +
               xml_attribute("xmlns:v", threemf::kVolumetric) + xml_attribute("xmlns:fw", threemf::kFretwork);
        if (painted(PaintFormat::kPrusa)) xml += xml_attribute("xmlns:slic3rpe", threemf::kSlic3r);
        xml += ">\n";
        const auto add = [&](std::string_view name, std::string_view value) {
            xml += "<metadata" + xml_attribute("name", name) + ">" + xml_escaped(value) + "</metadata>\n";
        };
        add("Application", package_.application);
        if (!package_.title.empty()) add("Title", package_.title);
        for (const auto& [name, value] : metadata_of(package_)) add(name, value);
        if (painted(PaintFormat::kPrusa))
            for (const std::string_view name : threemf::kSlic3rVersions) add(name, "1");
        return xml + "<resources>\n";
    }

    static std::string object_head(const CarvedObjectText& text, const std::string& id) {
        std::string xml = "<object" + xml_attribute("id", id) + " type=\"model\"";
        if (!text.object().name.empty()) xml += xml_attribute("name", text.object().name);
        if (text.colored()) xml += xml_attribute("pid", std::to_string(text.color_group())) + " pindex=\"0\"";
        xml += "><mesh";
        if (text.volume() != 0) xml += xml_attribute("v:volumeid", std::to_string(text.volume()));
        return xml + ">";
    }

    const CarvedPackage& package_;
    const RunControl& run_;
    ModelDialect dialect_;
    std::deque<CarvedObjectText> texts_;  ///< a deque, because pieces of the text point to them
    std::uint32_t next_id_ = 1;
};

}  // namespace

std::string write_carved_threemf(const CarvedPackage& package, const RunControl& run) {
    return PackageWriter(package, run).write();
}

void write_carved_threemf(const std::filesystem::path& path, const CarvedPackage& package, const RunControl& run) {
    atomic_write(path, write_carved_threemf(package, run));
}

}  // namespace fretwork
