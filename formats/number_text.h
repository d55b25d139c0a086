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

/// Appends the value of the nearest float, in full: whoever reads it as a float and whoever reads it as a double get
/// the same number, so that a mesh which is valid in one is valid in the other. The volatile step keeps g++ 12 from
/// dropping the conversion and back.
inline void append_float(std::string& out, double value) {
    const volatile float nearest = static_cast<float>(value);
    // Plus zero turns minus zero into zero.
    append_number(out, static_cast<double>(nearest) + 0.0);
}

}  // namespace fretwork
