// The one table of all settings: name, type, range, unit, help. Flags, specs, the JSON schema, the docs
// table and GUI properties are made from it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/pipeline/setting_value.h"
#include "core/pipeline/settings.h"

namespace fretwork {

enum class SettingType {
    kBool,
    kInteger,
    kNumber,
    kText,
    kChoice,       ///< one of `choices`
    kDirection,    ///< [x, y, z], not all zero
    kOrientation,  ///< "up", "free" or a direction
};

struct SettingRange {
    double min;
    double max;
    bool min_excluded = false;
};

struct SettingInfo {
    std::string key;  ///< "shell.thickness_mm"
    SettingType type = SettingType::kText;
    std::string unit;                   ///< "mm", "N", ...; "1" for plain numbers and names
    std::optional<SettingRange> range;  ///< of integers and numbers
    std::vector<std::string> choices;
    std::string when_unset;  ///< where the value then comes from; empty for keys that always have one
    std::string help;        ///< one line

    /// Empty when unset.
    std::function<std::optional<SettingValue>(const Settings&)> get;
    /// The value has the right type and lies in range.
    std::function<void(Settings&, const SettingValue&)> set;
};

/// Every key, in the order in which a spec lists them.
std::span<const SettingInfo> all_settings();

/// \throws InvalidSetting  no such key; names the nearest one.
const SettingInfo& setting_info(std::string_view key, std::string_view place = {});

/// Checks type and range, then sets. An integer will do for a number.
/// \throws InvalidSetting  names place, key, value and what was expected.
void apply_setting(Settings& settings, const SettingAssignment& assignment);

/// `text` as the key's type wants it: what stands after `=` in `--set key=value`.
/// \throws InvalidSetting
SettingAssignment parse_setting(std::string_view key, std::string_view text, std::string_view place);

/// "key=value" taken apart, then as `parse_setting`.
SettingAssignment parse_assignment(std::string_view key_and_value, std::string_view place);

/// Changes the defaults that a preset stands for.
void apply_preset(Settings& settings, Preset preset);

/// Built-in defaults < preset (the last one named) < assignments in order. Tables are added in order.
Settings settings_from(const SpecDocument& document);

/// The document that gives these settings back; keys that are unset are left out.
SpecDocument document_from(const Settings& settings);

/// The range, choices or form of a key in words, for messages and tables: "0.05 to 100 mm".
std::string describe_range(const SettingInfo& info);

/// The name nearest to `name` by edit distance.
std::string nearest_name(std::string_view name, std::span<const std::string> known);

}  // namespace fretwork
