// A strength report as named facts, for `verify`.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/strength_check.h"
#include "formats/facts_text.h"

namespace fretwork {

/// \param group   stands before each name, with its point: "strength."; may be empty
/// \param faults  see strength_faults.h
void add_strength_facts(const StrengthCheck& check, const std::vector<std::string>& faults, const std::string& group,
                        Facts& facts);

}  // namespace fretwork
