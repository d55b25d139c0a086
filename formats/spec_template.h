// A spec to start from: every key with its help, made from the table of settings.
#pragma once

#include <string>

#include "core/pipeline/settings.h"

namespace fretwork {

/// TOML with every key: help, range and unit as comments; keys at their default are commented out. Reading
/// it back gives the same settings.
std::string commented_spec(const Settings& settings);

/// The same table as Markdown, one row per key: what docs/spec.md holds.
std::string spec_markdown();

}  // namespace fretwork
