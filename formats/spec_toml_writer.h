// Assignments -> TOML text.
#pragma once

#include <string>

#include "core/pipeline/setting_value.h"

namespace fretwork {

/// Entries keep their order within a table; tables come in order of their first entry. Reading the
/// text gives the same keys and values, numbers to the last bit.
std::string write_spec_toml(const SpecDocument& document);

}  // namespace fretwork
