// Whether a model suits the printer that a slicer's profile describes; known before anything is carved.
#pragma once

#include <string>
#include <vector>

#include "core/base/vec.h"
#include "core/pipeline/settings.h"

namespace fretwork::cli {

/// One sentence for each thing that does not suit, with both numbers and what to change: a model that does not lie or
/// stand in what the printer reaches, a quarter turn about z allowed; a nozzle other than what the pattern is made for.
/// Keys that a profile or definition leaves out tell nothing.
/// \param size_mm  of the scaled model's box
/// \throws FileError  the profile cannot be read. \throws InvalidInput  see read_cura_definition
std::vector<std::string> printer_warnings(const std::string& profile, const Vec3& size_mm,
                                          const FabricationOptions& fabrication);

}  // namespace fretwork::cli
