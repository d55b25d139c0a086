// TOML text -> assignments, before anything is known about what the keys mean.
#pragma once

#include <filesystem>
#include <string_view>

#include "core/pipeline/setting_value.h"

namespace fretwork {

/// Tables become dotted keys; arrays of tables become `tables` (inside of a table too, then with its
/// path: "structure.loads", but not inside of each other). Assignments and tables come in the order
/// of the text, each with its place: "SOURCE: line 4, column 1". Lists hold numbers.
/// \throws InvalidSetting  naming the place: bad TOML; a date; a list of anything but numbers; a
///                         number that is not finite; text over 1 MiB; tables nested over 32 deep.
SpecDocument read_spec_toml(std::string_view text, std::string_view source);

/// \throws FileError  cannot be opened.
SpecDocument read_spec_toml(const std::filesystem::path& path);

}  // namespace fretwork
