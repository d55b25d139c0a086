// A spec as it was written: names, values and where they stand, before anything is checked.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace fretwork {

/// What a spec or a flag can hold for one key.
using SettingValue = std::variant<bool, std::int64_t, double, std::string, std::vector<double>>;

/// `key = value`, and the place to name in an error: "spec.toml:12", "--set".
struct SettingAssignment {
    std::string key;  ///< with its section: "shell.thickness_mm"
    SettingValue value;
    std::string place;
};

/// One `[[keep]]`, `[[carve]]`, `[[loads]]` or `[[fixtures]]` entry.
struct SettingTable {
    std::string array;
    std::vector<SettingAssignment> entries;  ///< keys without the array's name
    std::string place;
};

struct SpecDocument {
    std::vector<SettingAssignment> assignments;
    std::vector<SettingTable> tables;
};

/// The way a value is written in TOML: 2.5, true, "up", [0, 0, 1]. Doubles keep every digit they need.
std::string setting_text(const SettingValue& value);

}  // namespace fretwork
