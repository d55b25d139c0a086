#include "formats/cura_definition.h"

#include <map>
#include <nlohmann/json.hpp>
#include <string>

#include "formats/parse_error.h"
#include "formats/read_file.h"

namespace fretwork {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr std::size_t kMaxBytes = 4 << 20;
constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxParents = 16;

json parse(const fs::path& path) {
    const std::string text = read_file(path, kMaxBytes);
    const auto limit_depth = [&](int depth, json::parse_event_t, const json&) {
        if (depth > kMaxDepth) fail_parse(path.string(), "top level", "values nested over 64 deep", "a definition");
        return true;
    };
    try {
        return json::parse(text, limit_depth);
    } catch (const json::parse_error& error) {
        fail_parse(path.string(), place_of_byte(error.byte), "broken JSON", "a definition of CuraEngine");
    } catch (const json::out_of_range&) {
        fail_parse(path.string(), "somewhere", "a number beyond 1e308", "a definition of CuraEngine");
    }
}

/// Defaults of a tree of settings; those that are known already, of a child, stay.
void collect(const json& settings, std::map<std::string, json>& values) {
    if (!settings.is_object()) return;
    for (const auto& [name, setting] : settings.items()) {
        if (!setting.is_object()) continue;
        if (const auto value = setting.find("default_value"); value != setting.end()) values.emplace(name, *value);
        if (const auto children = setting.find("children"); children != setting.end()) collect(*children, values);
    }
}

std::optional<double> positive(const std::map<std::string, json>& values, const std::string& name) {
    const auto found = values.find(name);
    if (found == values.end() || !found->second.is_number() || found->second <= 0.0) return std::nullopt;
    return found->second.get<double>();
}

bool is_true(const std::map<std::string, json>& values, const std::string& name) {
    const auto found = values.find(name);
    return found != values.end() && found->second == true;
}

}  // namespace

CuraPrinter read_cura_definition(const fs::path& path) {
    CuraPrinter printer;
    std::map<std::string, json> values;
    for (fs::path at = path; !at.empty();) {
        if (printer.files.size() > kMaxParents)
            fail_parse(path.string(), "inherits", "over 16 definitions", "fewer that build on each other");
        printer.files.push_back(at);
        const json definition = parse(at);
        if (!definition.is_object())
            fail_parse(at.string(), "top level", definition.type_name(), "a definition of CuraEngine");
        for (const char* part : {"overrides", "settings"})
            if (const auto tree = definition.find(part); tree != definition.end()) collect(*tree, values);
        const auto parent = definition.find("inherits");
        at = parent != definition.end() && parent->is_string()
                 ? at.parent_path() / fs::path(parent->get<std::string>() + ".def.json").filename()
                 : fs::path();
        std::error_code none;
        if (!fs::exists(at, none)) at.clear();
    }
    const auto wide = positive(values, "machine_width"), deep = positive(values, "machine_depth"),
               high = positive(values, "machine_height");
    printer.nozzle_mm = positive(values, "machine_nozzle_size");
    if (!wide || !deep || !high) return printer;
    const Vec3 low = is_true(values, "machine_center_is_zero") ? Vec3(-*wide / 2, -*deep / 2, 0.0) : Vec3(0, 0, 0);
    printer.room_mm = {low, low + Vec3(*wide, *deep, *high)};
    return printer;
}

}  // namespace fretwork
