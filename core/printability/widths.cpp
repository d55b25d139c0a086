#include "core/printability/widths.h"

#include <cmath>
#include <utility>
#include <vector>

namespace fretwork {
namespace {

constexpr double kToleranceMm = 0.02;
constexpr double kRoundingMm = 0.01;  // of offsets there and back
constexpr double kLeastNeckMm2 = 0.002;

/// Parts that a disc of the radius cannot reach, and that are no corner or tip: these touch what it reaches once.
std::vector<Part> necks(const Polygons& area, double radius_mm) {
    const Polygons reached = offset(offset(area, -radius_mm), radius_mm);
    std::vector<Part> found;
    for (Part& part : parts_of(difference(area, offset(reached, kRoundingMm)))) {
        if (part.area_mm2() < kLeastNeckMm2) continue;
        const Polygons contacts = intersection(offset(part.borders, 3.0 * kRoundingMm), reached);
        if (parts_of(contacts).size() != 1) found.push_back(std::move(part));
    }
    return found;
}

/// What of the area lies around the parts.
Polygons around(const Polygons& area, const std::vector<Part>& parts, double margin_mm) {
    Polygons boxes;
    for (const Part& part : parts) boxes.push_back(box_around(part.borders, margin_mm));
    return intersection(area, boxes);
}

}  // namespace

std::optional<Neck> narrowest(const Polygons& area, double limit_mm) {
    std::vector<Part> found = necks(area, limit_mm / 2);
    if (found.empty()) return std::nullopt;
    double none_at = 0.0, some_at = limit_mm;
    while (some_at - none_at > kToleranceMm) {
        const double middle = 0.5 * (none_at + some_at);
        std::vector<Part> narrower = necks(around(area, found, 2.0 * limit_mm), middle / 2);
        if (narrower.empty()) {
            none_at = middle;
        } else {
            some_at = middle;
            found = std::move(narrower);
        }
    }
    const Polygon box = box_around(found.front().borders, 0.0);
    return Neck{0.5 * (mm_of(box[0]) + mm_of(box[2])), some_at};
}

std::optional<Neck> narrowest_gap(const Polygons& area, double limit_mm) {
    if (area.empty()) return std::nullopt;
    return narrowest(difference({box_around(area, 2.0 * limit_mm)}, area), limit_mm);
}

}  // namespace fretwork
