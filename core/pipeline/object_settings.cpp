#include "core/pipeline/object_settings.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/pipeline/settings_schema.h"

namespace fretwork {
namespace {

bool is_of_the_file(std::string_view key) {
    return key == "synthesis.preset" || key == "input.objects" || key == "input.ignore_required" ||
           (key.starts_with("output.") && key != "output.colour" && key != "output.voxel_data");
}

}  // namespace

ObjectOption object_option_from(const SettingTable& table) {
    ObjectOption option;
    Settings scratch;
    for (const SettingAssignment& entry : table.entries) {
        const std::string at = entry.place.empty() ? std::string{} : entry.place + ": ";
        if (entry.key == "match") {
            const auto* text = std::get_if<std::string>(&entry.value);
            if (text == nullptr || text->empty())
                throw InvalidSetting(fmt::format("{}match = {}: expected the name, number or part number of an object",
                                                 at, setting_text(entry.value)));
            option.match = *text;
            continue;
        }
        if (is_of_the_file(entry.key))
            throw InvalidSetting(
                fmt::format("{}{}: found in [[object]], expected once for the whole file", at, entry.key));
        apply_setting(scratch, entry);
        option.overrides.push_back(entry);
    }
    if (option.match.empty())
        throw InvalidSetting(fmt::format("{}{}[[object]] needs 'match', the name, number or part number of an object",
                                         table.place, table.place.empty() ? "" : ": "));
    return option;
}

SettingTable table_from(const ObjectOption& option) {
    SettingTable table{std::string(kObjectArray), {{"match", option.match, {}}}, {}};
    for (const SettingAssignment& entry : option.overrides) table.entries.push_back({entry.key, entry.value, {}});
    return table;
}

Settings settings_for_object(const Settings& settings, std::span<const std::string> names) {
    Settings own = settings;
    for (const ObjectOption& option : settings.objects) {
        if (std::ranges::find(names, option.match) == names.end()) continue;
        for (const SettingAssignment& entry : option.overrides) apply_setting(own, entry);
    }
    own.objects.clear();
    return own;
}

}  // namespace fretwork
