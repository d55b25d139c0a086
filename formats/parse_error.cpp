#include "formats/parse_error.h"

#include "core/base/error.h"

namespace fretwork {

void fail_parse(std::string_view source, std::string_view place, std::string_view found, std::string_view expected) {
    std::string message(source);
    message.append(": ").append(place).append(": found ").append(found).append(", expected ").append(expected);
    throw InvalidInput(message);
}

std::string in_quotes(std::string_view text, std::size_t longest) {
    constexpr std::string_view kHex = "0123456789abcdef";
    std::string out = "\"";
    for (const char c : text.substr(0, longest)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte >= 0x20 && byte < 0x7f) {
            out += c;
        } else {
            out += "\\x";
            out += kHex[byte >> 4];
            out += kHex[byte & 15];
        }
    }
    out += text.size() > longest ? "...\"" : "\"";
    return out;
}

std::string place_of_byte(std::size_t offset) {
    return "byte " + std::to_string(offset);
}

std::string place_of_line(std::size_t line) {
    return "line " + std::to_string(line);
}

}  // namespace fretwork
