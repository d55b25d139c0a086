#include "formats/carved_threemf_writer.h"

#include <algorithm>
#include <array>
#include <optional>

#include "core/base/error.h"
#include "formats/atomic_write.h"
#include "formats/mesh_writer_input.h"
#include "formats/number_text.h"
#include "formats/opc_parts.h"
#include "formats/threemf_names.h"
#include "formats/voxel_sheets.h"
#include "formats/xml_text.h"
#include "formats/zip_writer.h"

namespace fretwork {
namespace {

constexpr std::size_t kItemsPerPiece = 1 << 15;  ///< vertices or triangles packed at once
constexpr std::size_t kMostMetadataBytes = 1 << 18;

void append_attribute(std::string& out, std::string_view name_and_quote, std::uint64_t value) {
    out += name_and_quote;
    append_number(out, value);
    out += '"';
}

/// Different colours in ascending order.
std::vector<Rgb8> palette_of(std::span<const Rgb8> colors) {
    std::vector<Rgb8> palette(colors.begin(), colors.end());
    std::ranges::sort(palette);
    palette.erase(std::unique(palette.begin(), palette.end()), palette.end());
    return palette;
}

std::string hex_color(const Rgb8& color) {
    constexpr std::string_view kDigits = "0123456789ABCDEF";
    std::string text = "#";
    for (const std::uint8_t channel : color) {
        text += kDigits[channel >> 4];
        text += kDigits[channel & 15];
    }
    return text;
}

std::string sheet_path(std::string_view stack, std::size_t sheet) {
    std::string number = std::to_string(sheet);
    number.insert(0, 4 - std::min<std::size_t>(4, number.size()), '0');
    return "/3D/volumetric/" + std::string(stack) + "/sheet" + number + ".png";
}

/// One image3d with its sheets.
struct SheetStack {
    std::string name;
    int columns = 0;
    int rows = 0;
    std::vector<std::string> sheets;
};

/// One object with the numbers of its resources; 0 where it has none.
struct PlacedObject {
    const CarvedObject* object = nullptr;
    std::vector<Rgb8> palette;
    std::optional<SheetStack> field, reinforced;
    std::uint64_t color_group_id = 0;
    std::uint64_t volume_id = 0;
    std::uint64_t object_id = 0;
};

class PackageWriter {
  public:
    PackageWriter(const CarvedPackage& package, const RunControl& run) : package_(package), run_(run) {}

    std::string write() {
        check();
        for (std::size_t i = 0; i < package_.objects.size(); ++i) place(package_.objects[i], i);
        run_.checkpoint("write 3mf", 0.3);
        ZipWriter zip;
        zip.add(threemf::kContentTypesPart, content_types());
        zip.add(threemf::kRootRelationsPart, root_relations());
        zip.add_deflated(threemf::kModelPart, model());
        run_.checkpoint("write 3mf", 0.8);
        add_sheets(zip);
        if (!package_.spec_toml.empty()) zip.add("Metadata/fretwork.toml", package_.spec_toml);
        if (!package_.report_json.empty()) zip.add("Metadata/fretwork.json", package_.report_json);
        if (!package_.thumbnail_png.empty()) zip.add_stored("Metadata/thumbnail.png", package_.thumbnail_png);
        std::string bytes = zip.finish();
        run_.checkpoint("write 3mf", 1.0);
        return bytes;
    }

  private:
    void check() const {
        if (package_.objects.empty()) throw InvalidInput("write 3mf: found no object, expected at least one");
        for (const CarvedObject& object : package_.objects) {
            check_mesh_to_write({object.mesh, object.triangle_colors});
            if (object.mesh.triangles.empty())
                throw InvalidInput("write 3mf: object \"" + object.name + "\": found no triangle");
        }
        static constexpr std::array<std::string_view, 9> kKnown = {"Title",        "Designer",         "Description",
                                                                   "Copyright",    "LicenseTerms",     "Rating",
                                                                   "CreationDate", "ModificationDate", "Application"};
        for (const auto& [name, value] : package_.metadata)
            if (!name.starts_with("fw:") && std::ranges::find(kKnown, name) == kKnown.end())
                throw InvalidInput("write 3mf: metadata: found the name \"" + name +
                                   "\", expected one of the core specification or one that starts with fw:");
    }

    void place(const CarvedObject& object, std::size_t index) {
        PlacedObject placed;
        placed.object = &object;
        placed.palette = palette_of(object.triangle_colors);
        if (!placed.palette.empty()) placed.color_group_id = next_id_++;
        if (object.voxels != nullptr) {
            const std::string suffix = package_.objects.size() > 1 ? std::to_string(index + 1) : "";
            const VoxelGrid& grid = object.voxels->shell.grid;
            VoxelSheets sheets = make_voxel_sheets(*object.voxels, run_);
            placed.field = {"voxels" + suffix, grid.extent[0], grid.extent[1], std::move(sheets.field)};
            if (!sheets.reinforced.empty())
                placed.reinforced = {"reinforced" + suffix, grid.extent[0], grid.extent[1],
                                     std::move(sheets.reinforced)};
        }
        placed_.push_back(std::move(placed));
    }

    [[nodiscard]] static std::string content_types() {
        return content_types_xml({{"rels", "application/vnd.openxmlformats-package.relationships+xml"},
                                  {"model", "application/vnd.ms-package.3dmanufacturing-3dmodel+xml"},
                                  {"png", "image/png"},
                                  {"toml", "application/toml"},
                                  {"json", "application/json"}});
    }

    [[nodiscard]] std::string root_relations() const {
        std::vector<std::pair<std::string, std::string_view>> targets = {
            {"/" + std::string(threemf::kModelPart), threemf::kModelRelation}};
        if (!package_.thumbnail_png.empty())
            targets.emplace_back("/Metadata/thumbnail.png", threemf::kThumbnailRelation);
        if (!package_.spec_toml.empty()) targets.emplace_back("/Metadata/fretwork.toml", threemf::kSpecRelation);
        if (!package_.report_json.empty()) targets.emplace_back("/Metadata/fretwork.json", threemf::kReportRelation);
        return relationships_xml(targets);
    }

    void add_sheets(ZipWriter& zip) {
        std::vector<std::pair<std::string, std::string_view>> targets;
        for (PlacedObject& placed : placed_)
            for (auto* stack : {&placed.field, &placed.reinforced}) {
                if (!*stack) continue;
                for (std::size_t k = 0; k < (*stack)->sheets.size(); ++k) {
                    const std::string path = sheet_path((*stack)->name, k);
                    zip.add_stored(path.substr(1), std::move((*stack)->sheets[k]));
                    targets.emplace_back(path, threemf::kTextureRelation);
                }
            }
        if (!targets.empty()) zip.add(threemf::kModelRelationsPart, relationships_xml(targets));
    }

    /// The model part as pieces: texts as they are, and runs of vertices or triangles made when wanted.
    struct Piece {
        std::string text;
        const PlacedObject* placed = nullptr;
        bool triangles = false;
        std::size_t begin = 0;
    };

    DeflatedPart model() {
        std::vector<Piece> pieces;
        std::string text = model_head();
        for (PlacedObject& placed : placed_) text += resources(placed);
        for (const PlacedObject& placed : placed_) {
            text += object_head(placed);
            add_runs(pieces, text, placed, /*triangles=*/false);
            text = "</vertices><triangles>\n";
            add_runs(pieces, text, placed, /*triangles=*/true);
            text = "</triangles></mesh></object>\n";
        }
        text += "</resources>\n<build>\n";
        for (const PlacedObject& placed : placed_)
            text += "<item" + xml_attribute("objectid", std::to_string(placed.object_id)) + "/>\n";
        text += "</build>\n</model>\n";
        pieces.push_back({std::move(text)});
        return deflate_pieces(
            pieces.size(),
            [&](std::size_t i) {
                const Piece& piece = pieces[i];
                if (piece.placed == nullptr) return piece.text;
                return piece.triangles ? triangles_text(*piece.placed, piece.begin)
                                       : vertices_text(*piece.placed, piece.begin);
            },
            run_);
    }

    static void add_runs(std::vector<Piece>& pieces, std::string& text, const PlacedObject& placed, bool triangles) {
        pieces.push_back({std::move(text)});
        const TriangleMesh& mesh = placed.object->mesh;
        const std::size_t count = triangles ? mesh.triangles.size() : mesh.positions_mm.size();
        for (std::size_t begin = 0; begin < count; begin += kItemsPerPiece)
            pieces.push_back({{}, &placed, triangles, begin});
    }

    [[nodiscard]] std::string model_head() const {
        std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\"";
        const bool colored = std::ranges::any_of(placed_, [](const auto& p) { return !p.palette.empty(); });
        const bool volumetric = std::ranges::any_of(placed_, [](const auto& p) { return p.field.has_value(); });
        if (colored || volumetric)
            xml += xml_attribute("recommendedextensions", !volumetric ? "m" : !colored ? "v" : "m v");
        xml += xml_attribute("xmlns", threemf::kCore) + xml_attribute("xmlns:m", threemf::kMaterial) +
               xml_attribute("xmlns:v", threemf::kVolumetric) + xml_attribute("xmlns:fw", threemf::kFretwork) + ">\n";
        const auto add = [&](std::string_view name, std::string_view value) {
            xml += "<metadata" + xml_attribute("name", name) + ">" + xml_escaped(value) + "</metadata>\n";
        };
        add("Application", package_.application);
        if (!package_.title.empty()) add("Title", package_.title);
        for (const auto& [name, value] : package_.metadata) add(name, value);
        // Longer texts are in their own parts only: readers limit what an element may hold.
        if (!package_.spec_toml.empty() && package_.spec_toml.size() < kMostMetadataBytes)
            add("fw:spec", package_.spec_toml);
        if (!package_.report_json.empty() && package_.report_json.size() < kMostMetadataBytes)
            add("fw:report", package_.report_json);
        return xml + "<resources>\n";
    }

    std::string resources(PlacedObject& placed) {
        std::string xml;
        if (placed.color_group_id != 0) {
            xml += "<m:colorgroup" + xml_attribute("id", std::to_string(placed.color_group_id)) + ">";
            for (const Rgb8& color : placed.palette)
                xml += "<m:color" + xml_attribute("color", hex_color(color)) + "/>";
            xml += "</m:colorgroup>\n";
        }
        if (placed.field) {
            const std::uint64_t field = add_function(xml, *placed.field);
            const std::uint64_t reinforced = placed.reinforced ? add_function(xml, *placed.reinforced) : 0;
            placed.volume_id = next_id_++;
            xml += volume_data(placed, field, reinforced);
        }
        placed.object_id = next_id_++;
        return xml;
    }

    /// Appends the image and its function. \return id of the function
    std::uint64_t add_function(std::string& xml, const SheetStack& stack) {
        const std::string image = std::to_string(next_id_++);
        const std::uint64_t function = next_id_++;
        xml += "<v:image3d" + xml_attribute("id", image) + xml_attribute("name", stack.name) + "><v:imagestack" +
               xml_attribute("rowcount", std::to_string(stack.rows)) +
               xml_attribute("columncount", std::to_string(stack.columns)) +
               xml_attribute("sheetcount", std::to_string(stack.sheets.size())) + ">\n";
        for (std::size_t k = 0; k < stack.sheets.size(); ++k)
            xml += "<v:imagesheet" + xml_attribute("path", sheet_path(stack.name, k)) + "/>\n";
        xml += "</v:imagestack></v:image3d>\n<v:functionfromimage3d" + xml_attribute("id", std::to_string(function)) +
               xml_attribute("displayname", stack.name) + xml_attribute("image3did", image) +
               " filter=\"nearest\" valueoffset=\"0\" valuescale=\"1\" tilestyleu=\"clamp\" tilestylev=\"clamp\""
               " tilestylew=\"clamp\"/>\n";
        return function;
    }

    static std::string volume_data(const PlacedObject& placed, std::uint64_t field, std::uint64_t reinforced) {
        const std::string transform = xml_attribute("transform", grid_transform(placed.object->voxels->shell.grid));
        const auto property = [&](std::string_view name, std::uint64_t function, std::string_view channel) {
            return "<v:property" + xml_attribute("name", name) + " required=\"true\"" +
                   xml_attribute("functionid", std::to_string(function)) + xml_attribute("channel", channel) +
                   transform + "/>\n";
        };
        std::string xml = "<v:volumedata" + xml_attribute("id", std::to_string(placed.volume_id)) + ">\n";
        if (!placed.object->voxels->colors.empty())
            xml += "<v:color" + xml_attribute("functionid", std::to_string(field)) + xml_attribute("channel", "color") +
                   transform + "/>\n";
        xml += property("fw:solid", field, "alpha");
        if (reinforced != 0) xml += property("fw:reinforced", reinforced, "red");
        return xml + "</v:volumedata>\n";
    }

    /// From model coordinates to the unit cube over the grid; rows of a 4 x 3 matrix.
    static std::string grid_transform(const VoxelGrid& grid) {
        std::array<double, 12> t{};
        for (std::size_t k = 0; k < 3; ++k) {
            const double size = grid.voxel_mm * grid.extent[k];
            t[4 * k] = 1.0 / size;
            t[9 + k] = 0.0 - grid.origin_mm[static_cast<int>(k)] / size;
        }
        std::string text;
        for (std::size_t i = 0; i < t.size(); ++i) {
            if (i > 0) text += ' ';
            append_number(text, t[i]);
        }
        return text;
    }

    static std::string object_head(const PlacedObject& placed) {
        std::string xml = "<object" + xml_attribute("id", std::to_string(placed.object_id)) + " type=\"model\"";
        if (!placed.object->name.empty()) xml += xml_attribute("name", placed.object->name);
        if (placed.color_group_id != 0)
            xml += xml_attribute("pid", std::to_string(placed.color_group_id)) + " pindex=\"0\"";
        xml += "><mesh";
        if (placed.volume_id != 0) xml += xml_attribute("v:volumeid", std::to_string(placed.volume_id));
        return xml + "><vertices>\n";
    }

    static std::string vertices_text(const PlacedObject& placed, std::size_t begin) {
        const auto& positions = placed.object->mesh.positions_mm;
        const std::size_t end = std::min(positions.size(), begin + kItemsPerPiece);
        std::string xml;
        xml.reserve(64 * (end - begin));
        for (std::size_t v = begin; v < end; ++v) {
            static constexpr std::array<std::string_view, 3> kNames = {"<vertex x=\"", "\" y=\"", "\" z=\""};
            for (std::size_t k = 0; k < 3; ++k) {
                xml += kNames[k];
                append_float(xml, positions[v][static_cast<int>(k)]);
            }
            xml += "\"/>\n";
        }
        return xml;
    }

    static std::string triangles_text(const PlacedObject& placed, std::size_t begin) {
        const auto& triangles = placed.object->mesh.triangles;
        const std::size_t end = std::min(triangles.size(), begin + kItemsPerPiece);
        const std::string group = xml_attribute("pid", std::to_string(placed.color_group_id));
        std::string xml;
        xml.reserve(112 * (end - begin));
        for (std::size_t t = begin; t < end; ++t) {
            append_attribute(xml, "<triangle v1=\"", triangles[t][0]);
            append_attribute(xml, " v2=\"", triangles[t][1]);
            append_attribute(xml, " v3=\"", triangles[t][2]);
            if (placed.color_group_id != 0) {
                const auto color = std::ranges::lower_bound(placed.palette, placed.object->triangle_colors[t]);
                const auto index = static_cast<std::uint64_t>(color - placed.palette.begin());
                xml += group;
                for (const std::string_view corner : {" p1=\"", " p2=\"", " p3=\""})
                    append_attribute(xml, corner, index);
            }
            xml += "/>\n";
        }
        return xml;
    }

    const CarvedPackage& package_;
    const RunControl& run_;
    std::vector<PlacedObject> placed_;
    std::uint64_t next_id_ = 1;
};

}  // namespace

std::string write_carved_threemf(const CarvedPackage& package, const RunControl& run) {
    return PackageWriter(package, run).write();
}

void write_carved_threemf(const std::filesystem::path& path, const CarvedPackage& package, const RunControl& run) {
    atomic_write(path, write_carved_threemf(package, run));
}

}  // namespace fretwork
