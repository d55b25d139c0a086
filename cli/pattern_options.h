// The flags that say what is carved and how, shared by `carve` and `pattern preview`.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/picture_files.h"
#include "core/pipeline/choose_exemplar.h"
#include "core/pipeline/settings.h"

namespace fretwork::cli {

/// Values of the flags. Precedence: defaults < preset < spec < parameter set < -D/--set < named flags.
struct PatternOptions {
    std::string pattern;   ///< a built-in by name, or a spec by path
    std::string exemplar;  ///< picture
    std::string mask;
    std::string parameter_file, parameter_set;
    bool parameters_of_model = false;  ///< names without a dot in the parameter set are for OpenSCAD
    std::vector<std::string> assignments;
    std::string preset;
    std::string up;
    std::optional<std::uint64_t> seed;
    std::optional<double> size_mm, thickness_mm, width_mm;
    std::optional<int> resolution;
};

void add_setting_flags(CLI::App& command, PatternOptions& options);
void add_pattern_flags(CLI::App& command, PatternOptions& options);

/// The settings that the flags add up to.
/// \throws InvalidSetting, InvalidInput, FileError
Settings settings_of(const PatternOptions& options);

/// The same on top of those of an earlier run, in the place of a spec.
Settings settings_of(const PatternOptions& options, SpecDocument document);

/// The spec that --pattern names, or an empty one. Paths in it are meant from where it lies.
SpecDocument spec_of(const PatternOptions& options);

/// The document with its paths meant from the folder of `file`.
SpecDocument anchored(const std::string& file, SpecDocument document);

/// Whether --pattern names a spec rather than a built-in pattern.
bool names_spec(const std::string& pattern);

/// Reads or draws the exemplar that the settings name; valid until `pictures` is asked for another.
/// \throws InvalidSetting  none is named.
ChosenExemplar exemplar_of(const Settings& settings);
const ChosenExemplar& exemplar_of(const Settings& settings, PictureFiles& pictures);

/// Every file that the settings were made from, and the pictures.
std::vector<std::string> files_read(const PatternOptions& options, const PictureFiles& pictures);

}  // namespace fretwork::cli
