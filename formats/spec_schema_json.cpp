#include "formats/spec_schema_json.h"

#include <nlohmann/json.hpp>

#include "core/pipeline/object_settings.h"
#include "core/pipeline/region_schema.h"
#include "core/pipeline/settings_schema.h"

namespace fretwork {
namespace {

using Json = nlohmann::ordered_json;

Json vector_schema(int numbers) {
    Json schema = {{"type", "array"}, {"items", {{"type", "number"}}}};
    if (numbers > 0) {
        schema["minItems"] = numbers;
        schema["maxItems"] = numbers;
    }
    return schema;
}

Json value_json(const SettingValue& value) {
    return std::visit([](const auto& held) { return Json(held); }, value);
}

Json type_schema(const SettingInfo& info) {
    switch (info.type) {
        case SettingType::kBool:
            return {{"type", "boolean"}};
        case SettingType::kText:
            return {{"type", "string"}};
        case SettingType::kChoice:
            return {{"enum", info.choices}};
        case SettingType::kDirection:
            return vector_schema(3);
        case SettingType::kOrientation:
            return {{"anyOf", Json::array({{{"enum", {"up", "free"}}}, vector_schema(3)})}};
        case SettingType::kInteger:
        case SettingType::kNumber:
            break;
    }
    Json schema = {{"type", info.type == SettingType::kInteger ? "integer" : "number"}};
    if (info.range) {
        schema[info.range->min_excluded ? "exclusiveMinimum" : "minimum"] = info.range->min;
        schema["maximum"] = info.range->max;
    }
    return schema;
}

Json key_schema(const SettingInfo& info) {
    Json schema = type_schema(info);
    schema["description"] = info.help;
    if (info.unit != "1") schema["x-unit"] = info.unit;
    if (const auto value = info.get(Settings{}))
        schema["default"] = value_json(*value);
    else
        schema["x-default"] = info.when_unset;
    return schema;
}

Json region_key_schema(const RegionKeyInfo& key) {
    Json schema = key.numbers == 1 ? Json{{"type", "number"}} : vector_schema(key.numbers);
    schema["description"] = key.help;
    return schema;
}

// One alternative per shape, so that an editor offers the keys that go with it.
Json table_schema(const TableInfo& table) {
    Json alternatives = Json::array();
    for (const RegionShapeInfo& shape : region_shapes()) {
        Json properties = {{"shape", {{"const", shape.shape}, {"description", shape.help}}},
                           {"name", {{"type", "string"}}}};
        Json required = {"shape"};
        for (const RegionKeyInfo& key : shape.keys) {
            properties[key.key] = region_key_schema(key);
            required.push_back(key.key);
        }
        for (const RegionKeyInfo& key : shape.texts) {
            properties[key.key] = {{"type", "string"}, {"description", key.help}};
            required.push_back(key.key);
        }
        for (const RegionKeyInfo& key : table.numbers) properties[key.key] = region_key_schema(key);
        for (const RegionKeyInfo& key : table.texts)
            properties[key.key] = {{"type", "string"}, {"description", key.help}};
        alternatives.push_back(
            {{"type", "object"}, {"properties", properties}, {"required", required}, {"additionalProperties", false}});
    }
    return {{"type", "array"}, {"description", table.help}, {"items", {{"oneOf", alternatives}}}};
}

}  // namespace

std::string spec_schema_json() {
    Json sections = Json::object();
    for (const SettingInfo& info : all_settings()) {
        const auto dot = info.key.find('.');
        Json& section = sections[info.key.substr(0, dot)];
        section["type"] = "object";
        section["additionalProperties"] = false;
        section["properties"][info.key.substr(dot + 1)] = key_schema(info);
    }
    for (const TableInfo& table : table_infos()) sections[table.array] = table_schema(table);
    const Json own = {{"match", {{"type", "string"}, {"description", "Name, number or part number of the object."}}}};
    Json object = {{"type", "object"}, {"properties", own}, {"required", {"match"}}};
    for (const auto& [name, section] : sections.items())
        if (section["type"] == "object") object["properties"][name] = section;
    object["additionalProperties"] = false;
    sections[std::string(kObjectArray)] = {
        {"type", "array"}, {"description", kObjectHelp}, {"items", std::move(object)}};
    const Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                         {"title", "Fretwork spec"},
                         {"type", "object"},
                         {"properties", sections},
                         {"additionalProperties", false}};
    return schema.dump(2) + "\n";
}

}  // namespace fretwork
