// Extruder numbers on triangles, as slicers store them.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/pipeline/settings.h"

namespace fretwork {

/// Empty where nothing is painted.
struct TrianglePaint {
    PaintFormat format = PaintFormat::kNone;
    std::span<const std::uint8_t> extruders = {};  ///< one per triangle, from 1
};

/// A triangle that is painted as a whole: "4", "8", "0C", "1C" ... Both slicers read four bits at a time from the
/// end: how the triangle is split (not at all), and its state, which takes four bits more from 3 on.
/// \param extruder  1 to 16, what PrusaSlicer can hold
std::string paint_state_text(int extruder);

/// The other way round; 0 for a triangle that is split, and for what no slicer writes.
int extruder_of(std::string_view state_text);

}  // namespace fretwork
