// 3MF packages, sound and hostile, made part by part.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fretwork::testing {

using Parts = std::vector<std::pair<std::string, std::string>>;

/// A ZIP with these parts, packed.
std::string make_zip(const Parts& parts);

/// A package with content types, root relationships and this model part.
std::string make_package(const std::string& model_xml, const Parts& more = {});

/// A package whose model part unpacks to so many megabytes of blanks; made without holding them.
std::string make_zip_bomb(std::size_t megabytes);

/// `<model>` with the core, m, v, p and fw prefixes declared; `attributes` go into the start tag.
std::string make_model(const std::string& resources, const std::string& build, const std::string& attributes = "");

/// `<object>` with a tetrahedron of volume 1/6 at the origin.
std::string make_tetrahedron(int id, const std::string& attributes = "", const std::string& triangle_attributes = "");

/// Replaces every occurrence; both have the same length. For names within finished archives.
std::string patched(std::string bytes, std::string_view from, std::string_view to);

/// Overwrites `value`, little endian, at `offset` within every central directory record.
std::string with_central_field(std::string bytes, std::size_t offset, std::uint32_t value, int size);

}  // namespace fretwork::testing
