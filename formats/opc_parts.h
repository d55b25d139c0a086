// The two kinds of XML that every package has besides its model.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fretwork {

/// `[Content_Types].xml`. \param types  extension and content type
std::string content_types_xml(const std::vector<std::pair<std::string_view, std::string_view>>& types);

/// A relationships part. \param targets  path from the root, with a leading slash, and type
std::string relationships_xml(const std::vector<std::pair<std::string, std::string_view>>& targets);

}  // namespace fretwork
