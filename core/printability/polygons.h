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
std::vector<Part> parts_of(const Polygons& area);
bool contains(const Part& part, const ClipperLib::IntPoint& p);

/// The same borders, each moved by `mm`, and all points at most `mm` off: fewer of them.
Polygons cleaned(const Polygons& area, double mm);

/// Bounds of an area, grown by `margin_mm`.
Polygon box_around(const Polygons& area, double margin_mm);

}  // namespace fretwork
