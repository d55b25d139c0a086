// Distances to strokes, against every segment looked at in turn.
#include "core/exemplar/builtin/drawing.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace fretwork::drawing {
namespace {

struct Line {
    std::vector<Vec2> points;
    std::vector<double> radius;
};

/// A curl whose width swells and shrinks, of so many points.
Line curl(int points, double turns) {
    Line line;
    for (int i = 0; i < points; ++i) {
        const double t = static_cast<double>(i) / points, angle = 6.283 * turns * t, r = 6.0 + 20.0 * t;
        line.points.emplace_back(70.0 + r * std::cos(angle), 50.0 + r * std::sin(angle));
        line.radius.push_back(1.0 + 3.0 * std::abs(std::sin(9.0 * t)));
    }
    return line;
}

double nearest_of_all(const Line& line, const Vec2& p) {
    double best = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i) {
        const Vec2 a = line.points[i], ab = line.points[i + 1] - a;
        const double t = std::clamp((p - a).dot(ab) / ab.squaredNorm(), 0.0, 1.0);
        best = std::min(best, (p - a - t * ab).norm() - (1 - t) * line.radius[i] - t * line.radius[i + 1]);
    }
    return best;
}

TEST_CASE("drawing: a stroke's distance is that of its nearest segment, a lower bound far away", "[exemplar]") {
    const Torus torus{1000, 1000};  // larger than twice any way in here: no copy is nearer
    for (const int points : {2, 3, 8, 9, 10, 17, 60}) {
        const Line line = curl(points, 1.7);
        const Stroke stroke(line.points, line.radius);
        double deepest = 0.0;
        for (int i = 0; i < 4000; ++i) {
            const Vec2 p(160.0 * random_unit(1, static_cast<std::uint64_t>(i), 0),
                         120.0 * random_unit(1, static_cast<std::uint64_t>(i), 1));
            const double exact = nearest_of_all(line, p), told = stroke.distance(p, torus);
            deepest = std::min(deepest, exact);
            if (exact < Stroke::kNear) REQUIRE(told == Approx(exact).margin(1e-9));
            REQUIRE(told <= exact + 1e-9);
        }
        CHECK(deepest < -0.5);  // points inside were among them
    }
}

TEST_CASE("drawing: a stroke goes on across the borders of the torus", "[exemplar]") {
    const Torus torus{100, 80};
    const Stroke stroke({Vec2(2, 40), Vec2(8, 40)}, {2, 2});
    CHECK(stroke.distance(Vec2(97, 40), torus) == Approx(3.0));
    CHECK(stroke.distance(Vec2(5, 40), torus) == Approx(-2.0));
}

}  // namespace
}  // namespace fretwork::drawing
