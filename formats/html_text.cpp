#include "formats/html_text.h"

#include <cstddef>
#include <cstdint>

#include "formats/xml_text.h"

namespace fretwork {
std::string html_escaped(std::string_view text) {
    std::string out;
    for (const char c : xml_escaped(text)) {
        if (c == '\'')
            out += "&#39;";
        else if (c == '\x7F')
            out += "\xEF\xBF\xBD";
        else
            out += c;
    }
    return out;
}

std::string base64(std::string_view bytes) {
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        const std::size_t there = bytes.size() - i < 3 ? bytes.size() - i : 3;
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (k < there ? static_cast<std::uint8_t>(bytes[i + k]) : std::uint32_t{0});
        for (std::size_t k = 0; k < 4; ++k) out += k <= there ? kDigits[bits >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

std::string data_uri(std::string_view media_type, std::string_view bytes) {
    return "data:" + std::string(media_type) + ";base64," + base64(bytes);
}

}  // namespace fretwork
