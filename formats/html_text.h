// Text and bytes as they may stand in an HTML page.
#pragma once

#include <string>
#include <string_view>

namespace fretwork {

/// Safe between tags and within quoted attributes, single quotes too: otherwise as xml_escaped, and DEL becomes U+FFFD
/// as well.
std::string html_escaped(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// "data:image/jpeg;base64,..."
std::string data_uri(std::string_view media_type, std::string_view bytes);

}  // namespace fretwork
