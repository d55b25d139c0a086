// Plane polygons: sums, differences and offsets by Clipper. Internal to this folder and its tests.
#pragma once

#include <polyclipping/clipper.hpp>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// Closed borders of an area, solid on the left, in units of 10 nm: fine enough for any printer, and small enough for
/// Clipper to calculate in 64 bits up to 10 m.
using Polygons = ClipperLib::Paths;
using Polygon = ClipperLib::Path;

inline constexpr double kUnitsPerMm = 1e5;

inline ClipperLib::IntPoint point_of(const Vec2& mm) {
    return {static_cast<ClipperLib::cInt>(std::llround(mm[0] * kUnitsPerMm)),
            static_cast<ClipperLib::cInt>(std::llround(mm[1] * kUnitsPerMm))};
}
inline Vec2 mm_of(const ClipperLib::IntPoint& p) {
    return {static_cast<double>(p.X) / kUnitsPerMm, static_cast<double>(p.Y) / kUnitsPerMm};
}

/// One connected part: an outer border and its holes.
struct Part {
    Polygons borders;
    [[nodiscard]] double area_mm2() const;
};

double area_mm2(const Polygons& area);
Polygons intersection(const Polygons& a, const Polygons& b);
Polygons difference(const Polygons& a, const Polygons& b);
/// Where the winding number is above zero.
Polygons solid_of(const Polygons& loops);
/// Grown with round corners, or shrunk by a negative distance.
Polygons offset(const Polygons& area, double mm);
/// Parts less than `mm` apart become one, corners stay sharp.
Polygons with_gaps_closed(const Polygons& area, double mm);
std::vector<Part> parts_of(const Polygons& area);
bool contains(const Part& part, const ClipperLib::IntPoint& p);

/// The same borders with fewer points: what strays by less than `mm` is left out.
Polygons cleaned(const Polygons& area, double mm);

/// Corners of the box around an area, from the lowest on.
Polygon box_around(const Polygons& area);

}  // namespace fretwork
