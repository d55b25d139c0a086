// [[object]]: settings of their own for some objects of a model.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/pipeline/settings.h"

namespace fretwork {

inline constexpr std::string_view kObjectArray = "object";
inline constexpr std::string_view kObjectHelp = "Settings that one object of a 3MF has for itself.";

/// Checks an entry of [[object]]: `match` and any keys of a spec but the preset and those about the file as a whole
/// (`input.objects`, `input.ignore_required`, and `output` but for its colour and voxel data).
/// \throws InvalidSetting  naming the place.
ObjectOption object_option_from(const SettingTable& table);

/// The entry that gives it back.
SettingTable table_from(const ObjectOption& option);

/// The settings with the overrides of every entry that names the object, in order.
/// \param names  its name, number and part number
Settings settings_for_object(const Settings& settings, std::span<const std::string> names);

}  // namespace fretwork
