// Larger models that are not part of the project and may be absent.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

namespace fretwork::testing {

/// A file of the shared data beside the repository, or under the folder named by FRETWORK_SHARED_DATA; nothing where
/// it is absent, in which case a test says so by name and ends.
inline std::optional<std::filesystem::path> shared_data(const std::string& file) {
    const char* named = std::getenv("FRETWORK_SHARED_DATA");
    const std::filesystem::path folder =
        named != nullptr ? std::filesystem::path(named) : std::filesystem::path(FRETWORK_REPOSITORY) / "../shared/data";
    std::error_code absent;
    if (!std::filesystem::exists(folder / file, absent)) return std::nullopt;
    return folder / file;
}

}  // namespace fretwork::testing
