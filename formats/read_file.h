// Whole file -> memory.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace fretwork {

inline constexpr std::size_t kMaxFileBytes = std::size_t{4} << 30;

/// \throws FileError     cannot be opened or read; a directory.
/// \throws InvalidInput  longer than `max_bytes`, found out before it is in memory.
std::string read_file(const std::filesystem::path& path, std::size_t max_bytes = kMaxFileBytes);

}  // namespace fretwork
