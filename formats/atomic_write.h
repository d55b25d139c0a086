// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <string_view>

namespace fretwork {

/// Writes to a temporary file beside the target, flushes it to the disk and renames it onto the
/// target. On any failure the target is as it was and no temporary file is left. A new file gets the
/// permissions of an ordinary new file; a replaced one keeps its own. A symbolic link is followed.
/// \throws FileError  naming the path and the reason (no space left, read-only, no such folder ...).
void atomic_write(const std::filesystem::path& path, std::string_view bytes);

/// Whether both paths lead to one existing file, whatever the spelling or links.
[[nodiscard]] bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

}  // namespace fretwork
