#include "formats/parameter_set_reader.h"

#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "formats/parse_error.h"
#include "formats/read_file.h"

namespace fretwork {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxTextBytes = 1 << 20;
constexpr int kMaxDepth = 8;

std::string place_in(std::string_view text, std::size_t byte) {
    std::size_t line = 1, column = 1;
    for (const char c : text.substr(0, byte > 0 ? byte - 1 : 0)) {
        column = c == '\n' ? 1 : column + 1;
        line += c == '\n' ? 1 : 0;
    }
    return "line " + std::to_string(line) + ", column " + std::to_string(column);
}

json parse_shallow(std::string_view text, std::string_view source) {
    const auto limit_depth = [&](int depth, json::parse_event_t, const json&) {
        if (depth > kMaxDepth) fail_parse(source, "top level", "values nested over 8 deep", "parameter sets");
        return true;
    };
    try {
        return json::parse(text, limit_depth);
    } catch (const json::parse_error& error) {
        fail_parse(source, place_in(text, error.byte), "broken JSON", "parameter sets as OpenSCAD writes them");
    } catch (const json::out_of_range&) {
        fail_parse(source, "somewhere", "a number beyond 1e308", "parameter sets as OpenSCAD writes them");
    }
}

json parse_sets(std::string_view text, std::string_view source) {
    if (text.size() > kMaxTextBytes)
        fail_parse(source, place_of_byte(kMaxTextBytes), std::to_string(text.size()) + " bytes", "at most 1 MiB");
    const json root = parse_shallow(text, source);
    if (!root.is_object() || !root.contains("parameterSets") || !root["parameterSets"].is_object())
        fail_parse(source, "top level", "no object \"parameterSets\"", "parameter sets as OpenSCAD writes them");
    const std::string version = root.contains("fileFormatVersion") ? root["fileFormatVersion"].dump() : "1";
    if (version != "1" && version != "\"1\"") fail_parse(source, "fileFormatVersion", in_quotes(version), "\"1\"");
    return root["parameterSets"];
}

}  // namespace

std::vector<std::string> list_parameter_sets(std::string_view text, std::string_view source) {
    std::vector<std::string> names;
    const json sets = parse_sets(text, source);
    for (const auto& [name, set] : sets.items()) names.push_back(name);
    return names;
}

std::vector<SettingAssignment> read_parameter_set(std::string_view text, std::string_view source,
                                                  std::string_view set_name) {
    const json sets = parse_sets(text, source);
    const auto set = sets.find(set_name);
    if (set == sets.end()) {
        std::string known;
        for (const auto& [name, ignored] : sets.items()) known.append(known.empty() ? "" : ", ").append(name);
        throw InvalidSetting(std::string(source) + ": parameter set: found " + in_quotes(set_name) +
                             ", expected one of: " + (known.empty() ? "(the file has none)" : known));
    }
    if (!set->is_object()) fail_parse(source, "set " + in_quotes(set_name), set->type_name(), "an object");
    const std::string place = std::string(source) + ": set " + in_quotes(set_name);
    std::vector<SettingAssignment> assignments;
    for (const auto& [key, value] : set->items()) {
        if (value.is_structured() || value.is_null())
            fail_parse(place, key, value.type_name(), "a string, number or boolean");
        assignments.push_back({key, value.is_string() ? value.get<std::string>() : value.dump(), place});
    }
    return assignments;
}

std::vector<SettingAssignment> read_parameter_set(const std::filesystem::path& path, std::string_view set_name) {
    return read_parameter_set(read_file(path, kMaxTextBytes + 1), path.string(), set_name);
}

}  // namespace fretwork
