// The narrowest strands of a plane area. Internal to this folder and its tests.
#pragma once

#include <optional>

#include "core/printability/polygons.h"

namespace fretwork {

struct Neck {
    Vec2 at_mm = Vec2::Zero();
    double width_mm = 0.0;
};

/// The narrowest place with less than `limit_mm` that joins wider ones or stands alone; corners and tips are none,
/// however sharp. Width to 0.02 mm.
std::optional<Neck> narrowest(const Polygons& area, double limit_mm);

/// The same for what the area leaves empty.
std::optional<Neck> narrowest_gap(const Polygons& area, double limit_mm);

}  // namespace fretwork
