// What a 3MF package holds, and the run that made it, as named facts.
#pragma once

#include <string>
#include <string_view>

#include "formats/facts_text.h"
#include "formats/threemf_contents.h"

namespace fretwork {

/// As the group `package`.
void add_package_facts(const ThreemfContents& contents, Facts& facts);

/// What the report of a run says of shell, pattern, structure, mesh and printability, below `group`, which ends with a
/// point. Nothing for a text that is no report.
void add_run_facts(std::string_view report_json, const std::string& group, Facts& facts);

}  // namespace fretwork
