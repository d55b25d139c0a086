// A name for bytes that only these bytes have.
#pragma once

#include <string>
#include <string_view>

namespace fretwork {

/// SHA-256 in 64 hexadecimal digits.
std::string content_hash(std::string_view bytes);

}  // namespace fretwork
