#include "formats/carved_object_text.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "core/base/error.h"
#include "formats/color_channel.h"
#include "formats/mesh_writer_input.h"
#include "formats/number_text.h"
#include "formats/sheet_names.h"
#include "formats/slicer_paint.h"
#include "formats/xml_text.h"

namespace fretwork {
namespace {

constexpr std::size_t kItemsPerPiece = 1 << 13;  ///< vertices or triangles packed at once

void append_attribute(std::string& out, std::string_view name_and_quote, std::uint64_t value) {
    out += name_and_quote;
    append_number(out, value);
    out += '"';
}

std::string number_attribute(std::string_view name, std::uint64_t value) {
    return xml_attribute(name, std::to_string(value));
}

/// In the order of arrays, but as one number to compare.
std::uint32_t rank_of(const Rgb8& color) {
    return std::uint32_t{color[0]} << 16 | std::uint32_t{color[1]} << 8 | color[2];
}

/// Different colours in ascending order.
std::vector<Rgb8> palette_of(std::span<const Rgb8> colors) {
    std::vector<Rgb8> palette;
    // Neighbours mostly have one colour.
    std::ranges::unique_copy(colors, std::back_inserter(palette));
    std::ranges::sort(palette, {}, rank_of);
    palette.erase(std::unique(palette.begin(), palette.end()), palette.end());
    return palette;
}

/// From model coordinates to the unit cube over the grid; rows of a 4 x 3 matrix.
std::string grid_transform(const VoxelGrid& grid, double units_per_mm) {
    std::array<double, 12> t{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double size = grid.voxel_mm * grid.extent[k];
        t[4 * k] = 1.0 / (size * units_per_mm);
        t[9 + k] = 0.0 - grid.origin_mm[static_cast<int>(k)] / size;
    }
    std::string text;
    for (std::size_t i = 0; i < t.size(); ++i) {
        if (i > 0) text += ' ';
        append_number(text, t[i]);
    }
    return text;
}

}  // namespace

CarvedObjectText::CarvedObjectText(const CarvedObject& object, const std::string& stack_suffix, const RunControl& run)
    : object_(object), palette_(palette_of(object.triangle_colors)) {
    check_mesh_to_write({object.mesh, object.triangle_colors});
    if (object.mesh.triangles.empty())
        throw InvalidInput("write 3mf: object \"" + object.name + "\": found no triangle");
    if (!object.paint.extruders.empty() && object.paint.extruders.size() != object.mesh.triangles.size())
        throw InvalidInput("write 3mf: object \"" + object.name + "\": found " +
                           std::to_string(object.paint.extruders.size()) + " extruders, expected one per triangle");
    if (object.voxels != nullptr) own_sheets_ = make_voxel_sheets(*object.voxels, run);
    sheets_ = object.voxels != nullptr ? &own_sheets_ : object.sheets;
    field_stack_ = std::string(kFieldStack) + stack_suffix;
    reinforced_stack_ = std::string(kReinforcedStack) + stack_suffix;
    facts_stack_ = std::string(kFactsStack) + stack_suffix;
}

std::string CarvedObjectText::resources(const ModelDialect& dialect, const std::function<std::uint32_t()>& next_id) {
    std::string xml;
    if (colored()) {
        color_group_ = next_id();
        xml += "<" + dialect.material + "colorgroup" + number_attribute("id", color_group_) + ">";
        for (const Rgb8& color : palette_)
            xml += "<" + dialect.material + "color" + xml_attribute("color", hex_color(color)) + "/>";
        xml += "</" + dialect.material + "colorgroup>\n";
    }
    if (sheets_ == nullptr) return xml;
    const auto image = [&](const std::string& stack, const VoxelGrid& grid, std::size_t sheet_count) {
        return add_image(xml, dialect, stack, grid, sheet_count, next_id);
    };
    const auto function = [&](const std::string& name, std::uint32_t of_image, double scale) {
        return add_function(xml, dialect, name, of_image, scale, next_id);
    };
    Functions functions;
    functions.field = function(field_stack_, image(field_stack_, sheets_->grid, sheets_->field.size()), 1.0);
    if (!sheets_->reinforced.empty())
        functions.reinforced =
            function(reinforced_stack_, image(reinforced_stack_, sheets_->grid, sheets_->reinforced.size()), 1.0);
    if (!sheets_->facts.empty()) {
        const std::uint32_t facts = image(facts_stack_, sheets_->facts_grid, sheets_->facts.size());
        if (sheets_->most_stress_mpa > 0.0) functions.stress = function("stress", facts, sheets_->most_stress_mpa);
        functions.label = function("label", facts, 65535.0);
    }
    volume_ = next_id();
    return xml + volume_data(dialect, functions);
}

/// Appends the image. \return its id
std::uint32_t CarvedObjectText::add_image(std::string& xml, const ModelDialect& dialect, const std::string& stack,
                                          const VoxelGrid& grid, std::size_t sheet_count,
                                          const std::function<std::uint32_t()>& next_id) const {
    const std::uint32_t image = next_id();
    const std::string open = "<" + dialect.volumetric, close = "</" + dialect.volumetric;
    xml += open + "image3d" + number_attribute("id", image) + xml_attribute("name", stack) + ">" + open + "imagestack" +
           xml_attribute("rowcount", std::to_string(grid.extent[1])) +
           xml_attribute("columncount", std::to_string(grid.extent[0])) + number_attribute("sheetcount", sheet_count) +
           ">\n";
    for (std::size_t k = 0; k < sheet_count; ++k)
        xml += open + "imagesheet" + xml_attribute("path", sheet_path(stack, k)) + "/>\n";
    xml += close + "imagestack>" + close + "image3d>\n";
    return image;
}

/// Appends a function of an image. \return its id
std::uint32_t CarvedObjectText::add_function(std::string& xml, const ModelDialect& dialect, const std::string& name,
                                             std::uint32_t image, double scale,
                                             const std::function<std::uint32_t()>& next_id) {
    const std::uint32_t function = next_id();
    std::string scale_text;
    append_number(scale_text, scale);
    xml += "<" + dialect.volumetric + "functionfromimage3d" + number_attribute("id", function) +
           xml_attribute("displayname", name) + number_attribute("image3did", image) +
           " filter=\"nearest\" valueoffset=\"0\"" + xml_attribute("valuescale", scale_text) +
           " tilestyleu=\"clamp\" tilestylev=\"clamp\" tilestylew=\"clamp\"/>\n";
    return function;
}

std::string CarvedObjectText::volume_data(const ModelDialect& dialect, const Functions& functions) const {
    const auto transform_of = [&](const VoxelGrid& grid) {
        return xml_attribute("transform", grid_transform(grid, dialect.units_per_mm));
    };
    const std::string fine = transform_of(sheets_->grid), coarse = transform_of(sheets_->facts_grid);
    const auto property = [&](const std::string& name, std::uint32_t function, std::string_view channel,
                              const std::string& transform) {
        return "<" + dialect.volumetric + "property" + xml_attribute("name", dialect.own + name) +
               " required=\"true\"" + number_attribute("functionid", function) + xml_attribute("channel", channel) +
               transform + "/>\n";
    };
    std::string xml = "<" + dialect.volumetric + "volumedata" + number_attribute("id", volume_) + ">\n";
    if (sheets_->colored)
        xml += "<" + dialect.volumetric + "color" + number_attribute("functionid", functions.field) +
               xml_attribute("channel", "color") + fine + "/>\n";
    xml += property("solid", functions.field, "alpha", fine);
    if (functions.reinforced != 0) xml += property("reinforced", functions.reinforced, "red", fine);
    if (functions.stress != 0) xml += property("stress", functions.stress, "red", coarse);
    if (functions.label != 0) xml += property("label", functions.label, "green", coarse);
    return xml + "</" + dialect.volumetric + "volumedata>\n";
}

void CarvedObjectText::append_mesh(const ModelDialect& dialect, TextPieces& pieces) const {
    pieces.add("<" + dialect.core + "vertices>\n");
    for (std::size_t begin = 0; begin < object_.mesh.positions_mm.size(); begin += kItemsPerPiece)
        pieces.add_made([this, dialect, begin] { return vertices(dialect, begin); });
    pieces.add("</" + dialect.core + "vertices><" + dialect.core + "triangles>\n");
    for (std::size_t begin = 0; begin < object_.mesh.triangles.size(); begin += kItemsPerPiece)
        pieces.add_made([this, dialect, begin] { return triangles(dialect, begin); });
    pieces.add("</" + dialect.core + "triangles>");
}

std::string CarvedObjectText::vertices(const ModelDialect& dialect, std::size_t begin) const {
    const auto& positions = object_.mesh.positions_mm;
    const std::size_t end = std::min(positions.size(), begin + kItemsPerPiece);
    const std::string open = "<" + dialect.core + "vertex x=\"";
    std::string xml;
    xml.reserve(64 * (end - begin));
    for (std::size_t v = begin; v < end; ++v) {
        const Vec3 p = dialect.units_per_mm * positions[v];
        xml += open;
        append_float(xml, p[0]);
        xml += "\" y=\"";
        append_float(xml, p[1]);
        xml += "\" z=\"";
        append_float(xml, p[2]);
        xml += "\"/>\n";
    }
    return xml;
}

std::string CarvedObjectText::triangles(const ModelDialect& dialect, std::size_t begin) const {
    const auto& triangles = object_.mesh.triangles;
    const std::size_t end = std::min(triangles.size(), begin + kItemsPerPiece);
    const std::string open = "<" + dialect.core + "triangle v1=\"";
    const std::string group = number_attribute("pid", color_group_);
    const TrianglePaint& paint = object_.paint;
    const bool painted = paint.format != PaintFormat::kNone && !paint.extruders.empty();
    const std::string paint_name =
        paint.format == PaintFormat::kPrusa ? dialect.slicer + "mmu_segmentation" : "paint_color";
    std::string xml, properties;
    xml.reserve(112 * (end - begin));
    for (std::size_t t = begin; t < end; ++t) {
        append_attribute(xml, open, triangles[t][0]);
        append_attribute(xml, " v2=\"", triangles[t][1]);
        append_attribute(xml, " v3=\"", triangles[t][2]);
        if (colored()) {
            if (t == begin || object_.triangle_colors[t] != object_.triangle_colors[t - 1]) {
                const auto color = std::ranges::lower_bound(palette_, rank_of(object_.triangle_colors[t]), {}, rank_of);
                const auto index = static_cast<std::uint64_t>(color - palette_.begin());
                properties = group;
                for (const std::string_view corner : {" p1=\"", " p2=\"", " p3=\""})
                    append_attribute(properties, corner, index);
            }
            xml += properties;
        }
        if (painted) xml += xml_attribute(paint_name, paint_state_text(paint.extruders[t]));
        xml += "/>\n";
    }
    return xml;
}

std::vector<std::pair<std::string, std::string>> CarvedObjectText::sheets() const {
    std::vector<std::pair<std::string, std::string>> all;
    if (sheets_ == nullptr) return all;
    for (std::size_t k = 0; k < sheets_->field.size(); ++k)
        all.emplace_back(sheet_path(field_stack_, k), sheets_->field[k]);
    for (std::size_t k = 0; k < sheets_->reinforced.size(); ++k)
        all.emplace_back(sheet_path(reinforced_stack_, k), sheets_->reinforced[k]);
    for (std::size_t k = 0; k < sheets_->facts.size(); ++k)
        all.emplace_back(sheet_path(facts_stack_, k), sheets_->facts[k]);
    return all;
}

}  // namespace fretwork
