// Text -> XML attribute values and character data.
#pragma once

#include <string>
#include <string_view>

namespace fretwork {

/// Escaped for both uses. Characters that XML 1.0 does not allow, and bytes that are not UTF-8, become
/// U+FFFD; line ends and tabs stay as character data keeps them.
[[nodiscard]] std::string xml_escaped(std::string_view text);

/// ` name="value"`, the value escaped.
[[nodiscard]] std::string xml_attribute(std::string_view name, std::string_view value);

}  // namespace fretwork
