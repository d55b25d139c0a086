// The small schema of the entries of [[keep]], [[carve]], [[loads]] and [[fixtures]]. [[object]] has its own file.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/pipeline/setting_value.h"
#include "core/pipeline/settings.h"

namespace fretwork {

struct RegionKeyInfo {
    std::string key;   ///< "center_mm"
    int numbers = 1;   ///< how many; 0 for a list of any length
    std::string help;  ///< one line, with unit and range
};

struct RegionShapeInfo {
    std::string shape;  ///< value of the key `shape`: "sphere"
    std::string help;
    std::vector<RegionKeyInfo> keys;        ///< that hold numbers; all required
    std::string example;                    ///< as in a spec, without `shape`
    std::vector<RegionKeyInfo> texts = {};  ///< that hold text; all required
};

struct TableInfo {
    std::string array;  ///< "loads"
    std::string help;
    std::vector<RegionKeyInfo> numbers;  ///< optional keys that hold numbers
    std::vector<RegionKeyInfo> texts;    ///< optional keys that hold text
};

std::span<const RegionShapeInfo> region_shapes();
std::span<const TableInfo> table_infos();

/// Checks one entry and adds it to the settings.
/// \throws InvalidSetting  an unknown array, shape or key; a missing or superfluous key; a value of the
///                         wrong form. Names the place.
void apply_table(Settings& settings, const SettingTable& table);

/// The entries that give `settings` its regions, loads and fixtures back.
std::vector<SettingTable> tables_from(const Settings& settings);

}  // namespace fretwork
