// What an OpenSCAD file says to Fretwork: a spec in a comment, and which variables it has.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace fretwork {

/// The spec in a block comment that begins with the word fretwork on its first line:
///
///     /* fretwork
///     [exemplar]
///     pattern = "cells"
///     */
///
/// Lines keep their numbers: the text is led by as many empty lines as stand before it in the file.
/// \throws InvalidInput  a second such comment, or one without an end; names the line.
std::optional<std::string> spec_in_scad(std::string_view text, std::string_view source);

/// Names that the file itself assigns outside of all braces, parentheses and comments: what -D and parameter sets can
/// change. Files that it includes are not looked into.
std::set<std::string, std::less<>> variables_of_scad(std::string_view text);

/// Paths of `include <...>` outside of comments and texts, as they are written.
std::vector<std::string> included_by_scad(std::string_view text);

}  // namespace fretwork
