#include "core/printability/lost_parts.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"
#include "core/printability/layers.h"

namespace fretwork {
namespace {

constexpr double kLeastLines = 1.5;  // slicers may leave out a single line here and there

struct Box2 {
    Vec2 low = Vec2::Constant(std::numeric_limits<double>::infinity());
    Vec2 high = -low;

    void add(const Vec2& p) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    [[nodiscard]] Vec2 size() const { return high - low; }
    [[nodiscard]] Vec2 middle() const { return 0.5 * (low + high); }
    [[nodiscard]] bool holds(const Vec2& p) const {
        return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
    }
};

Box2 box_of(const Polygons& area) {
    const Polygon corners = box_around(area);
    Box2 box;
    box.add(mm_of(corners[0]));
    box.add(mm_of(corners[2]));
    return box;
}

bool any_within(const Polygons& area, const std::vector<Vec2>& points, const Vec2& shift) {
    const Box2 box = box_of(area);
    const std::vector<Part> parts = parts_of(area);
    return std::ranges::any_of(points, [&](const Vec2& printed) {
        const Vec2 p = printed - shift;
        return box.holds(p) &&
               std::ranges::any_of(parts, [&](const Part& part) { return contains(part, point_of(p)); });
    });
}

/// Parts wide enough for lines that no point comes near to.
std::vector<PrintPlace> lost_in(const Layer& layer, const PrintedLayer& printed, const Vec2& shift, double line_mm) {
    std::vector<PrintPlace> lost;
    for (const Part& part : parts_of(layer.outline)) {
        if (offset(part.borders, -0.5 * kLeastLines * line_mm).empty()) continue;
        if (any_within(offset(part.borders, 0.5 * line_mm), printed.points_mm, shift)) continue;
        const Vec2 middle = box_of(part.borders).middle();
        lost.push_back({Vec3(middle[0], middle[1], layer.middle_mm), std::sqrt(part.area_mm2())});
    }
    return lost;
}

}  // namespace

LostParts find_lost_parts(const TriangleMesh& mesh, const std::vector<PrintedLayer>& layers, double line_mm,
                          const RunControl& run) {
    Box2 mesh_box, printed_box;
    double bottom = std::numeric_limits<double>::infinity();
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) {
            mesh_box.add(mesh.positions_mm[v].head<2>());
            bottom = std::min(bottom, mesh.positions_mm[v][2]);
        }
    std::vector<double> heights;
    for (const PrintedLayer& layer : layers) {
        for (const Vec2& p : layer.points_mm) printed_box.add(p);
        heights.push_back(bottom + layer.top_mm - 0.5 * layer.height_mm);
    }
    LostParts lost;
    // Lines run half their width inside.
    const double slack = 4.0 * line_mm;
    if (heights.empty() || !((mesh_box.size() - printed_box.size()).cwiseAbs().maxCoeff() <= slack)) return lost;
    lost.compared = true;
    const Vec2 shift = printed_box.middle() - mesh_box.middle();
    const std::vector<Layer> cuts = cut_at(mesh, heights, run);
    std::vector<std::vector<PrintPlace>> found(cuts.size());
    parallel_for(cuts.size(), 1, [&](std::size_t i) { found[i] = lost_in(cuts[i], layers[i], shift, line_mm); });
    for (const auto& places : found) lost.places.insert(lost.places.end(), places.begin(), places.end());
    return lost;
}

}  // namespace fretwork
