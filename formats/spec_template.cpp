#include "formats/spec_template.h"

#include <fmt/format.h>

#include "core/pipeline/object_settings.h"
#include "core/pipeline/region_schema.h"
#include "core/pipeline/settings_schema.h"

namespace fretwork {
namespace {

std::string section_of(const SettingInfo& info) {
    return info.key.substr(0, info.key.find('.'));
}

std::string name_of(const SettingInfo& info) {
    return info.key.substr(info.key.find('.') + 1);
}

// Settings with which the reader starts before it sees the keys: the preset's, under the name "default".
Settings starting_point(const Settings& settings) {
    Settings start;
    apply_preset(start, settings.synthesis.preset);
    start.synthesis.preset = Preset::kDefault;
    return start;
}

std::string key_lines(const SettingInfo& info, const Settings& settings, const Settings& start) {
    std::string out = fmt::format("\n# {}\n# {}", info.help, describe_range(info));
    if (!info.when_unset.empty()) out += fmt::format("; unset: {}", info.when_unset);
    const auto value = info.get(settings);
    const bool changed = value != info.get(start);
    return out + (value ? fmt::format("\n{}{} = {}\n", changed ? "" : "# ", name_of(info), setting_text(*value))
                        : fmt::format("\n# {} =\n", name_of(info)));
}

std::string table_help() {
    std::string out = "\n# Regions, as many of each as needed. Lengths are those of the scaled model.\n";
    for (const TableInfo& info : table_infos()) {
        out += fmt::format("#\n# [[{}]]  {}\n", info.array, info.help);
        for (const RegionKeyInfo& key : info.numbers) out += fmt::format("#   {:<13} {}\n", key.key, key.help);
        for (const RegionKeyInfo& key : info.texts) out += fmt::format("#   {:<13} {}\n", key.key, key.help);
    }
    out += "#\n# Each has a shape, with the keys that follow it here (one per line in a spec):\n";
    for (const RegionShapeInfo& info : region_shapes())
        out += fmt::format("#   {:<13} {}  {}\n", info.shape, info.help, info.example);
    out +=
        fmt::format("#\n# [[{}]]  {}\n#   match         its name, number or part number\n", kObjectArray, kObjectHelp);
    out += "#   synthesis.seed = 5, shell.thickness_mm = 2 ... (one per line)\n";
    return out + "#\n# [[keep]]\n# shape = \"lowest\"\n# share = 0.05\n";
}

std::string table_lines(const Settings& settings) {
    std::string out;
    for (const SettingTable& table : tables_from(settings)) {
        out += fmt::format("\n[[{}]]\n", table.array);
        for (const SettingAssignment& entry : table.entries)
            out += fmt::format("{} = {}\n", entry.key, setting_text(entry.value));
    }
    return out;
}

std::string default_text(const SettingInfo& info) {
    const auto value = info.get(Settings{});
    return value ? fmt::format("`{}`", setting_text(*value)) : info.when_unset;
}

}  // namespace

std::string commented_spec(const Settings& settings) {
    const Settings start = starting_point(settings);
    std::string out = "# A Fretwork spec. Remove the # before a key to change it.\n", section;
    for (const SettingInfo& info : all_settings()) {
        if (section_of(info) != section) {
            section = section_of(info);
            out += fmt::format("\n[{}]\n", section);
        }
        out += key_lines(info, settings, start);
    }
    return out + table_help() + table_lines(settings);
}

std::string spec_markdown() {
    std::string out, section;
    for (const SettingInfo& info : all_settings()) {
        if (section_of(info) != section) {
            section = section_of(info);
            out += fmt::format("{}## [{}]\n\n| key | value | default | meaning |\n|---|---|---|---|\n",
                               out.empty() ? "" : "\n", section);
        }
        out += fmt::format("| `{}` | {} | {} | {} |\n", name_of(info), describe_range(info), default_text(info),
                           info.help);
    }
    out += "\n## Regions\n\n| table | meaning | keys beside the shape |\n|---|---|---|\n";
    for (const TableInfo& info : table_infos()) {
        std::string keys;
        for (const auto* list : {&info.numbers, &info.texts})
            for (const RegionKeyInfo& key : *list)
                keys += fmt::format("{}`{}`: {}", keys.empty() ? "" : " ", key.key, key.help);
        out += fmt::format("| `[[{}]]` | {} | {} |\n", info.array, info.help, keys);
    }
    out += fmt::format(
        "| `[[{}]]` | {} | `match`: its name, number or part number; then any key, as in `synthesis.seed = 5`. |\n",
        kObjectArray, kObjectHelp);
    out += "\n| shape | meaning | example |\n|---|---|---|\n";
    for (const RegionShapeInfo& info : region_shapes())
        out += fmt::format("| `{}` | {} | {}{}{} |\n", info.shape, info.help, info.example.empty() ? "" : "`",
                           info.example, info.example.empty() ? "" : "`");
    return out;
}

}  // namespace fretwork
