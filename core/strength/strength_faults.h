// What of a strength report keeps an object from holding.
#pragma once

#include <string>
#include <vector>

#include "core/strength/strength.h"

namespace fretwork {

/// One sentence with numbers and place where the object does not stand its loads with the safety that was asked for;
/// else empty.
std::vector<std::string> strength_faults(const StrengthReport& report);

/// What deserves a second look, in the same form.
std::vector<std::string> strength_cautions(const StrengthReport& report);

}  // namespace fretwork
