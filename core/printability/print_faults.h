// What of a printability report keeps a print from succeeding.
#pragma once

#include <string>
#include <vector>

#include "core/printability/printability.h"

namespace fretwork {

/// One sentence for each fault, with numbers and place; empty where nothing stands against printing. Overhangs, islands
/// and bridges are none: supports help. Hollows without a way out matter to resin and powder only.
/// \param nozzle_mm  width of a printed line: what is narrower is left out or widened by slicers; above 0
std::vector<std::string> print_faults(const PrintabilityReport& report, double nozzle_mm);

/// What asks for supports or a second look, in the same form.
std::vector<std::string> print_cautions(const PrintabilityReport& report);

}  // namespace fretwork
