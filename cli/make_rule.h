// Dependencies for make.
#pragma once

#include <span>
#include <string>

namespace fretwork::cli {

/// "out.3mf: model.stl pattern.toml" and an empty rule per input, so that a deleted input is no error. Blanks,
/// `$` and `#` are escaped as make wants them.
std::string make_rule(const std::string& target, std::span<const std::string> inputs);

}  // namespace fretwork::cli
