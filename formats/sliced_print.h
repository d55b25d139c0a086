// What a slicer has made of a model.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "core/base/vec.h"
#include "core/printability/lost_parts.h"

namespace fretwork {

/// Of G-code, or of an archive of pictures for a resin printer.
struct SlicedPrint {
    std::vector<PrintedLayer> layers;    ///< upwards; points only of lines that belong to the object, none for resin
    std::vector<Vec2> empty_between_mm;  ///< from and to which height nothing is printed
    std::optional<double> seconds;       ///< the slicer's estimate
    std::optional<double> filament_mm, filament_g, material_ml;
    std::optional<double> line_mm;                      ///< width of a line
    Vec3 min_mm = Vec3::Zero(), max_mm = Vec3::Zero();  ///< of all that is printed, supports and brim too
    std::optional<std::array<Vec3, 2>> room_mm;         ///< corners of what the printer can reach
};

}  // namespace fretwork
