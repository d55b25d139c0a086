// The run that carved a package, as facts.
#pragma once

#include "cli/files.h"
#include "core/pipeline/settings.h"
#include "formats/facts_text.h"

namespace fretwork::cli {

/// Settings that differ from what they are where nothing is asked for, and how many entries each list of tables has.
/// \param group  stands before each name, with its point; may be empty
void add_settings_facts(const Settings& settings, const std::string& group, Facts& facts);

/// As the group `carved`: version, model and pictures of the run, its settings and what came of it. Nothing for a
/// package that Fretwork did not carve; a record that cannot be read is told as `carved.damaged`.
void add_carved_facts(const ModelBytes& package, Facts& facts);

}  // namespace fretwork::cli
