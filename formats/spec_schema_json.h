// The JSON schema of a spec, for editors that complete and check TOML.
#pragma once

#include <string>

namespace fretwork {

/// JSON Schema, draft 2020-12, made from the table of settings.
std::string spec_schema_json();

}  // namespace fretwork
