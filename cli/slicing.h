// On to the slicer: a carved file -> G-code, and whether anything of it went missing.
#pragma once

#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "core/pipeline/run_report.h"

namespace fretwork::cli {

struct Slicing {
    std::string bytes;  ///< G-code, or an archive of pictures for a resin printer
    SliceRecord record;
};

/// Where the slicer's result goes: beside the model, with the ending that the profile asks for.
/// \param profile  an .ini of PrusaSlicer, or a .def.json of CuraEngine
/// \throws FileError       the profile cannot be read. \throws InvalidSetting  neither of these.
std::string sliced_path(const std::string& model, const std::string& profile);

/// The profile, and of a definition those that it builds on.
/// \throws FileError  it cannot be read. \throws InvalidInput  see read_cura_definition
std::vector<std::string> profile_files(const std::string& profile);

/// Slices with PrusaSlicer (filament or resin, as the profile says) or CuraEngine and reads what comes out.
/// \param model  a file on disk that the slicer can read
/// \throws FileError     the slicer cannot be run.
/// \throws InvalidInput  it ends with an error or makes nothing; names what it said last.
Slicing slice(const std::string& model, const std::string& profile, const RunControl& run);

}  // namespace fretwork::cli
