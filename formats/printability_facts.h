// A printability report as named facts, for `verify` and the run report.
#pragma once

#include <string>
#include <vector>

#include "core/printability/printability.h"
#include "formats/facts_text.h"

namespace fretwork {

/// \param group   stands before each name, with its point: "printability."; may be empty
/// \param faults  see print_faults.h
void add_printability_facts(const PrintabilityReport& report, const std::vector<std::string>& faults,
                            const std::string& group, Facts& facts);

}  // namespace fretwork
