// Numbers -> text, fast and without regard to locale.
#pragma once

#include <charconv>
#include <string>

namespace fretwork {

/// Appends the shortest decimal text that reads back as exactly `value`.
template <class Number>
void append_number(std::string& out, Number value) {
    char text[40];
    const auto [end, error] = std::to_chars(text, text + sizeof text, value);
    out.append(text, end);
}

}  // namespace fretwork
