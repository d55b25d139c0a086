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

/// Whether the path names an OpenSCAD file.
bool is_scad(const std::string& path);

/// Moves what is for OpenSCAD out of `pattern`. Parameter sets stay, since they may hold keys of both kinds.
ScadOptions take_scad_options(PatternOptions& pattern);

struct ScadModel {
    /// As OFF, in millimetres. Its warnings are what OpenSCAD has said, and variables that the file does not have.
    ModelBytes model;
    std::optional<std::string> spec;  ///< from the file's comment, see spec_in_scad
    std::vector<SettingTable> marks;  ///< what the modules of fretwork.scad mark
};

enum class ScadMarks { kRender, kLeaveOut };

/// Renders the file, and its marks on request.
/// \throws FileError       the file cannot be opened, or OpenSCAD cannot be run.
/// \throws InvalidInput    OpenSCAD reports an error or makes nothing; see render_marks.
/// \throws InvalidSetting  a parameter set that does not exist, or holds a name that the file does not assign.
ScadModel render_scad(const std::string& path, const ScadOptions& options, ScadMarks marks, const RunControl& run);

}  // namespace fretwork::cli
