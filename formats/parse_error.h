// One shape for every complaint about a file: where, what was found, what was expected.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace fretwork {

/// \throws InvalidInput  "SOURCE: PLACE: found FOUND, expected EXPECTED"
[[noreturn]] void fail_parse(std::string_view source, std::string_view place, std::string_view found,
                             std::string_view expected);

/// Text from a file made fit for a message: quoted, at most so many bytes, unprintable ones as \xNN.
[[nodiscard]] std::string in_quotes(std::string_view text, std::size_t longest = 40);

/// "byte 84"
[[nodiscard]] std::string place_of_byte(std::size_t offset);

/// "line 3"
[[nodiscard]] std::string place_of_line(std::size_t line);

}  // namespace fretwork
