#include "formats/threemf_facts.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace fretwork {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostText = 200;  ///< of a value of the metadata

std::int64_t number(std::size_t count) {
    return static_cast<std::int64_t>(count);
}

/// Specs and reports of whole pages stand in metadata; where they do, their length is told.
std::string shortened(const std::string& text) {
    return text.size() <= kMostText ? text : fmt::format("({} bytes)", text.size());
}

std::vector<Facts> parts_of(const ThreemfContents& contents) {
    std::vector<Facts> list;
    for (const PackagePartInfo& part : contents.parts)
        list.push_back({{{"path", part.path},
                         {"content_type", part.content_type},
                         {"bytes", static_cast<std::int64_t>(part.bytes)}}});
    return list;
}

std::vector<Facts> metadata_of(const ThreemfContents& contents) {
    std::vector<Facts> list;
    for (const auto& [name, value] : contents.metadata) list.push_back({{{"name", name}, {"value", shortened(value)}}});
    return list;
}

std::vector<Facts> extensions_of(const ThreemfContents& contents) {
    std::vector<Facts> list;
    for (const ThreemfExtension& e : contents.extensions)
        list.push_back({{{"namespace", e.space}, {"required", e.required}, {"understood", e.understood}}});
    return list;
}

std::vector<Facts> materials_of(const ThreemfContents& contents) {
    std::vector<Facts> list;
    for (const MaterialGroupInfo& group : contents.materials)
        list.push_back({{{"part", group.part},
                         {"id", std::int64_t{group.id}},
                         {"kind", group.kind},
                         {"entries", number(group.entries)},
                         {"first", group.first}}});
    return list;
}

std::vector<Facts> paint_of(const ThreemfContents& contents) {
    std::vector<Facts> list;
    for (const SlicerPaintInfo& paint : contents.paint) {
        Facts facts{{{"attribute", paint.attribute}, {"triangles", number(paint.triangles)}}};
        for (const auto& [extruder, triangles] : paint.extruders)
            facts.add(fmt::format("extruders.{}", extruder), number(triangles));
        list.push_back(std::move(facts));
    }
    return list;
}

std::vector<Facts> voxel_data_of(const ThreemfContents& contents) {
    std::vector<Facts> list;
    for (const VoxelDataInfo& data : contents.voxel_data) {
        std::vector<Facts> properties;
        for (const VoxelPropertyInfo& p : data.properties)
            properties.push_back({{{"name", p.name},
                                   {"columns", p.columns},
                                   {"rows", p.rows},
                                   {"sheets", p.sheets},
                                   {"voxel_mm", std::vector<double>{p.voxel_mm[0], p.voxel_mm[1], p.voxel_mm[2]}}}});
        list.push_back({{{"object", std::int64_t{data.object.id}},
                         {"part", data.object.part},
                         {"name", data.object_name},
                         {"properties", properties}}});
    }
    return list;
}

std::vector<Facts> carried_of(const ThreemfContents& contents) {
    std::vector<Facts> list;
    for (const CarriedElements& c : contents.carried)
        list.push_back({{{"element", c.name}, {"namespace", c.space}, {"count", number(c.count)}}});
    return list;
}

/// Objects become dotted names; lists of objects, which are long, are left out.
void add_json(const Json& json, const std::string& name, Facts& facts) {
    const auto all = [&](auto is) { return !json.empty() && std::ranges::all_of(json, is); };
    if (json.is_object())
        for (const auto& [key, value] : json.items()) add_json(value, fmt::format("{}.{}", name, key), facts);
    else if (json.is_boolean())
        facts.add(name, json.get<bool>());
    else if (json.is_number_integer())
        facts.add(name, json.get<std::int64_t>());
    else if (json.is_number())
        facts.add(name, json.get<double>());
    else if (json.is_string())
        facts.add(name, json.get<std::string>());
    else if (json.is_array() && all([](const Json& v) { return v.is_number(); }))
        facts.add(name, json.get<std::vector<double>>());
    else if (json.is_array() && all([](const Json& v) { return v.is_string(); }))
        facts.add(name, json.get<std::vector<std::string>>());
}

}  // namespace

void add_package_facts(const ThreemfContents& contents, Facts& facts) {
    facts.add("package.model_part", contents.model_part);
    facts.add("package.thumbnail", contents.thumbnail);
    facts.add("package.metadata", metadata_of(contents));
    facts.add("package.extensions", extensions_of(contents));
    facts.add("package.materials", materials_of(contents));
    facts.add("package.paint", paint_of(contents));
    facts.add("package.voxel_data", voxel_data_of(contents));
    facts.add("package.image_sheets", number(contents.image_sheets));
    facts.add("package.carried", carried_of(contents));
    facts.add("package.parts", parts_of(contents));
}

void add_run_facts(std::string_view report_json, const std::string& group, Facts& facts) {
    const Json report = Json::parse(report_json, nullptr, false);
    if (!report.is_object()) return;
    for (const char* part : {"shell", "pattern", "structure", "mesh", "printability", "warnings"})
        if (report.contains(part)) add_json(report[part], group + part, facts);
}

}  // namespace fretwork
