#include "core/exemplar/builtin/voronoi.h"

#include <utility>

namespace fretwork::drawing {

Voronoi::Voronoi(const Torus& torus, std::vector<Vec2> sites) : torus_(torus), sites_(std::move(sites)) {}

VoronoiWall Voronoi::wall(const Vec2& p, double rounding) const {
    return wall(p, rounding, [](const Vec2&) { return 0.0; });
}

VoronoiWall Voronoi::wall(const Vec2& p, double rounding, const std::function<double(const Vec2&)>& half_width) const {
    VoronoiWall out;
    double nearest = -1;
    for (std::size_t i = 0; i < sites_.size(); ++i) {
        const Vec2 way = torus_.shortest(p - sites_[i]);
        if (nearest < 0 || way.squaredNorm() < nearest) {
            nearest = way.squaredNorm();
            out.cell = i;
            out.from_site = way;
        }
    }
    std::vector<double> walls;
    walls.reserve(sites_.size());
    for (std::size_t i = 0; i < sites_.size(); ++i) {
        if (i == out.cell) continue;
        const Vec2 to = torus_.shortest(sites_[i] - sites_[out.cell]);
        const Vec2 across = to.normalized();
        walls.push_back((to / 2 - out.from_site).dot(across) - half_width(across));
    }
    out.distance = smooth_min(walls, rounding);
    return out;
}

}  // namespace fretwork::drawing
