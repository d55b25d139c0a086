// The full analysis of a report as HTML.
#pragma once

#include <string>

#include "core/pipeline/run_report.h"

namespace fretwork {

/// What holds under which load, the weakest places with their coordinates, and what each round of strengthening did.
std::string strength_section(const StrengthRecord& strength);

}  // namespace fretwork
