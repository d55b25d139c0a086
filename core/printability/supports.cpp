#include "core/printability/supports.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/mesh/triangle_math.h"

namespace fretwork {
namespace {

using Edge = std::pair<Vec2, Vec2>;

constexpr double kLeastIslandMm2 = 0.01;  // less is rounding
constexpr double kClosedGapMm = 0.098;    // slicers close narrower gaps before they draw lines
constexpr double kLeastHangingMm = 0.2;   // narrower rims are part of any slope
constexpr int kSamplesAcross = 40;
constexpr double kLeastSpacingMm = 0.1;

Vec2 closest_on(const Edge& edge, const Vec2& p) {
    return closest_on_segment(p, edge.first, edge.second);
}

void add_edges(const Polygon& border, std::vector<Edge>& edges) {
    for (std::size_t i = 0; i < border.size(); ++i)
        edges.emplace_back(mm_of(border[i]), mm_of(border[(i + 1) % border.size()]));
}

/// Points on the borders of a part, at most `spacing` apart, and a grid of them inside.
std::vector<Vec2> points_of(const Part& part) {
    const Polygon box = box_around(part.borders);
    const Vec2 low = mm_of(box[0]), high = mm_of(box[2]);
    const double spacing = std::max((high - low).maxCoeff() / kSamplesAcross, kLeastSpacingMm);
    std::vector<Vec2> points;
    std::vector<Edge> edges;
    for (const Polygon& border : part.borders) add_edges(border, edges);
    for (const auto& [a, b] : edges) {
        const int steps = std::max(1, static_cast<int>(std::ceil((b - a).norm() / spacing)));
        for (int i = 0; i < steps; ++i) points.emplace_back(a + (b - a) * i / steps);
    }
    for (double y = low[1] + spacing / 2; y < high[1]; y += spacing)
        for (double x = low[0] + spacing / 2; x < high[0]; x += spacing)
            if (contains(part, point_of(Vec2(x, y)))) points.emplace_back(x, y);
    return points;
}

double distance_to(const std::vector<Edge>& edges, const Vec2& p) {
    double least = std::numeric_limits<double>::infinity();
    for (const Edge& edge : edges) least = std::min(least, (closest_on(edge, p) - p).squaredNorm());
    return std::sqrt(least);
}

/// Whether what is about as near as the nearest support lies on opposite sides of `p`.
bool held_from_both_sides(const std::vector<Edge>& edges, const Vec2& p, double distance) {
    constexpr double kMuchFarther = 1.25, kCosOpposite = -0.5;
    std::vector<Vec2> directions;
    for (const Edge& edge : edges) {
        const Vec2 way = closest_on(edge, p) - p;
        if (way.norm() <= kMuchFarther * distance + kLeastSpacingMm) directions.emplace_back(way.normalized());
    }
    for (std::size_t i = 0; i < directions.size(); ++i)
        for (std::size_t k = 0; k < i; ++k)
            if (directions[i].dot(directions[k]) < kCosOpposite) return true;
    return false;
}

/// The layer's parts, and what each of them rests on.
class Rest {
  public:
    Rest(const Layer& layer, const Layer& below) {
        const Polygons closed = with_gaps_closed(layer.outline, kClosedGapMm);
        parts_ = parts_of(closed);
        edges_.resize(parts_.size());
        for (const Polygon& border : intersection(closed, below.outline))
            add_edges(border, edges_[part_at(border.front())]);
    }

    [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }
    [[nodiscard]] const std::vector<Edge>& support_of(std::size_t part) const { return edges_[part]; }

    /// The part that holds the point, or the nearest: where borders cross, the point is rounded and may lie a hair
    /// outside of the part it belongs to.
    [[nodiscard]] std::size_t part_at(const ClipperLib::IntPoint& p) const {
        for (std::size_t i = 0; i < parts_.size(); ++i)
            if (contains(parts_[i], p)) return i;
        const auto distance = [&](const Part& part) {
            std::vector<Edge> edges;
            for (const Polygon& border : part.borders) add_edges(border, edges);
            return distance_to(edges, mm_of(p));
        };
        return static_cast<std::size_t>(std::ranges::min_element(parts_, {}, distance) - parts_.begin());
    }

  private:
    std::vector<Part> parts_;
    std::vector<std::vector<Edge>> edges_;
};

PrintPlace place(const Vec2& at, double z, double size) {
    return {Vec3(at[0], at[1], z), size};
}

Vec2 middle_of(const Part& part) {
    const Polygon box = box_around(part.borders);
    return 0.5 * (mm_of(box[0]) + mm_of(box[2]));
}

/// The point of a hanging part that is farthest from what the layer rests on.
void measure(const Part& hanging, const std::vector<Edge>& support, double z, LayerSupports& found) {
    double farthest = 0.0;
    Vec2 at = Vec2::Zero();
    for (const Vec2& p : points_of(hanging)) {
        const double distance = distance_to(support, p);
        if (distance > farthest) farthest = distance, at = p;
    }
    const bool bridge = held_from_both_sides(support, at, farthest);
    PrintPlace& longest = bridge ? found.longest_bridge : found.longest_cantilever;
    const double size = bridge ? 2.0 * farthest : farthest;
    if (size > longest.size_mm) longest = place(at, z, size);
}

}  // namespace

LayerSupports look_below(const Layer& layer, const Layer& below, double reach_mm) {
    LayerSupports found;
    const Polygons over = difference(layer.outline, offset(below.outline, reach_mm));
    if (over.empty()) return found;
    found.overhang_mm2 = area_mm2(over);
    const Rest rest(layer, below);
    for (std::size_t i = 0; i < rest.parts().size(); ++i) {
        const Part& part = rest.parts()[i];
        if (rest.support_of(i).empty() && part.area_mm2() > kLeastIslandMm2)
            found.islands.push_back(place(middle_of(part), layer.middle_mm, std::sqrt(part.area_mm2())));
    }
    const Polygons wide = offset(offset(over, -kLeastHangingMm / 2), kLeastHangingMm / 2);
    for (const Part& hanging : parts_of(wide)) {
        const std::vector<Edge>& support = rest.support_of(rest.part_at(hanging.borders.front().front()));
        if (!support.empty()) measure(hanging, support, layer.middle_mm, found);
    }
    return found;
}

}  // namespace fretwork
