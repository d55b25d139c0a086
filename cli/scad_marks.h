// Marks of fretwork.scad in an OpenSCAD file -> regions, loads and fixtures.
#pragma once

#include <string>
#include <vector>

#include "cli/openscad.h"
#include "core/base/run_control.h"
#include "core/pipeline/setting_value.h"

namespace fretwork::cli {

/// What the library says of one mark.
struct ScadMark {
    std::string kind, name;  ///< "keep", "carve", "loads" or "fixtures"
    std::string values;      ///< the rest of the list, as JSON

    bool operator==(const ScadMark&) const = default;
};

/// The marks in the messages of a rendered body, each once, in order.
/// \throws InvalidSetting  two of one kind and name that say different things.
std::vector<ScadMark> marks_in(const std::vector<std::string>& lines, const std::string& path);

/// Renders each mark, and adds the files that this has read.
/// Cost  one run of OpenSCAD for each mark and one more.
/// \throws InvalidInput  a mark that draws nothing, or no volume; anything drawn outside of the body and the marks.
std::vector<SettingTable> render_marks(const OpenScad& scad, const std::vector<ScadMark>& marks,
                                       std::set<std::string>& files, const RunControl& run);

}  // namespace fretwork::cli
