#include "core/printability/polygons.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fretwork {
namespace {

using namespace ClipperLib;

constexpr double kArcToleranceMm = 0.005;

Polygons combine(ClipType type, const Polygons& a, const Polygons& b) {
    Clipper clipper;
    clipper.AddPaths(a, ptSubject, true);
    clipper.AddPaths(b, ptClip, true);
    Polygons result;
    clipper.Execute(type, result, pftNonZero, pftNonZero);
    return result;
}

double square_mm2(double square_units) {
    return square_units / (kUnitsPerMm * kUnitsPerMm);
}

/// Outer borders lie at even depth; each is a part with the holes right below it.
void collect(const PolyNode& node, std::vector<Part>& parts) {
    for (const PolyNode* outer : node.Childs) {
        Part part;
        part.borders.push_back(outer->Contour);
        for (const PolyNode* hole : outer->Childs) {
            part.borders.push_back(hole->Contour);
            collect(*hole, parts);
        }
        parts.push_back(std::move(part));
    }
}

}  // namespace

double area_mm2(const Polygons& area) {
    double sum = 0.0;
    for (const Polygon& border : area) sum += Area(border);
    return square_mm2(sum);
}

double Part::area_mm2() const {
    return fretwork::area_mm2(borders);
}

Polygons intersection(const Polygons& a, const Polygons& b) {
    return combine(ctIntersection, a, b);
}

Polygons difference(const Polygons& a, const Polygons& b) {
    return combine(ctDifference, a, b);
}

Polygons solid_of(const Polygons& loops) {
    Clipper clipper;
    clipper.AddPaths(loops, ptSubject, true);
    Polygons result;
    clipper.Execute(ctUnion, result, pftPositive, pftPositive);
    return result;
}

Polygons offset(const Polygons& area, double mm) {
    ClipperOffset grow(2.0, kArcToleranceMm * kUnitsPerMm);
    grow.AddPaths(area, jtRound, etClosedPolygon);
    Polygons result;
    grow.Execute(result, mm * kUnitsPerMm);
    return result;
}

Polygons with_gaps_closed(const Polygons& area, double mm) {
    constexpr double kMiterLimit = 3.0;
    Polygons result = area;
    for (const double by : {0.5 * mm, -0.5 * mm}) {
        ClipperOffset step(kMiterLimit);
        step.AddPaths(result, jtMiter, etClosedPolygon);
        step.Execute(result, by * kUnitsPerMm);
    }
    return result;
}

std::vector<Part> parts_of(const Polygons& area) {
    Clipper clipper;
    clipper.AddPaths(area, ptSubject, true);
    PolyTree tree;
    clipper.Execute(ctUnion, tree, pftNonZero, pftNonZero);
    std::vector<Part> parts;
    collect(tree, parts);
    return parts;
}

bool contains(const Part& part, const IntPoint& p) {
    for (std::size_t i = 0; i < part.borders.size(); ++i) {
        const int where = PointInPolygon(p, part.borders[i]);
        if (where < 0) return true;                  // on a border
        if ((where == 0) == (i == 0)) return false;  // outside of the outer one, or within a hole
    }
    return true;
}

Polygons cleaned(const Polygons& area, double mm) {
    Polygons result;
    CleanPolygons(area, result, mm * kUnitsPerMm);
    std::erase_if(result, [](const Polygon& border) { return border.size() < 3; });
    return result;
}

Polygon box_around(const Polygons& area) {
    constexpr cInt kFar = std::numeric_limits<cInt>::max();
    IntPoint low(kFar, kFar), high(-kFar, -kFar);
    for (const Polygon& border : area)
        for (const IntPoint& p : border) {
            low = {std::min(low.X, p.X), std::min(low.Y, p.Y)};
            high = {std::max(high.X, p.X), std::max(high.Y, p.Y)};
        }
    return {low, {high.X, low.Y}, high, {low.X, high.Y}};
}

}  // namespace fretwork
