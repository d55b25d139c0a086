// How the image stacks of carved objects and their sheets are called.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace fretwork {

/// First part of the names of stacks; behind it stands a number, or nothing.
inline constexpr std::string_view kFieldStack = "voxels", kReinforcedStack = "reinforced", kFactsStack = "facts";
inline constexpr std::array kStacks = {kFieldStack, kReinforcedStack, kFactsStack};

/// "/3D/volumetric/voxels1/sheet0002.png"
[[nodiscard]] std::string sheet_path(std::string_view stack, std::size_t sheet);

/// What stands behind the first part of the name of its stack; nothing where no carve can have put a sheet there.
/// \param path  with a leading slash, in any case
[[nodiscard]] std::optional<std::string> stack_suffix_of(std::string_view path);

}  // namespace fretwork
