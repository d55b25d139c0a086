// OpenSCAD Customizer parameter sets (JSON) -> assignments.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/pipeline/setting_value.h"

namespace fretwork {

/// `{"parameterSets": {NAME: {KEY: "text", ...}}, "fileFormatVersion": "1"}`. Values come as strings
/// (numbers and booleans that some programs write bare become their text); which kind each should be
/// is for the schema to say.
/// \throws InvalidInput    broken JSON (with line and column), another shape or version.
/// \throws InvalidSetting  no such set; names those there are.
std::vector<SettingAssignment> read_parameter_set(std::string_view text, std::string_view source,
                                                  std::string_view set_name);

/// \throws FileError  cannot be opened.
std::vector<SettingAssignment> read_parameter_set(const std::filesystem::path& path, std::string_view set_name);

/// Names of the sets, in order of the alphabet.
std::vector<std::string> list_parameter_sets(std::string_view text, std::string_view source);

}  // namespace fretwork
