// Definition of a printer for CuraEngine (.def.json) -> what the printer can reach.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <vector>

#include "core/base/vec.h"

namespace fretwork {

struct CuraPrinter {
    std::optional<std::array<Vec3, 2>> room_mm;  ///< corners, in the coordinates of the G-code; none where a side lacks
    std::optional<double> nozzle_mm;
    std::vector<std::filesystem::path> files;  ///< that were read: the definition and those that it builds on
};

/// Values are the `default_value` of settings and overrides, as the engine takes them; what a definition inherits is
/// looked for beside it, and missing parents are passed over, as the engine knows more places.
/// \throws FileError     cannot be opened.
/// \throws InvalidInput  over 4 MiB, broken JSON, nested over 64 deep or inherited over 16 times.
CuraPrinter read_cura_definition(const std::filesystem::path& path);

}  // namespace fretwork
