// OpenSCAD files as models, rendered by OpenSCAD itself.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cli/files.h"
#include "cli/openscad.h"
#include "cli/pattern_options.h"
#include "core/base/run_control.h"
#include "core/pipeline/setting_value.h"

namespace fretwork::cli {

/// Whether it is an OpenSCAD file, by its name or by the format `scad`.
bool is_scad(const ModelSource& source);

/// Moves what is for OpenSCAD out of `pattern`. Parameter sets stay, since they may hold keys of both kinds.
ScadOptions take_scad_options(PatternOptions& pattern);

struct ScadModel {
    /// As OFF, in millimetres. Its warnings are what OpenSCAD has said.
    ModelBytes model;
    std::optional<std::string> spec;  ///< from the file's comment, see spec_in_scad
    std::vector<SettingTable> marks;  ///< what the modules of fretwork.scad mark
};

enum class ScadMarks { kRender, kLeaveOut };

/// Renders the file, or standard input where the path is "-", and its marks on request. What standard input includes
/// and imports is meant from the current folder.
/// \throws FileError       the file cannot be opened, or OpenSCAD cannot be run.
/// \throws InvalidInput    OpenSCAD reports an error or makes nothing; see render_marks.
/// \throws InvalidSetting  a parameter set that does not exist, or holds a name that the file does not assign;
///                         a -D of a variable that neither the file nor what it includes assigns.
ScadModel render_scad(const std::string& path, const ScadOptions& options, ScadMarks marks, const RunControl& run);

}  // namespace fretwork::cli
