// Drawing on a torus with signed distances: shapes, inks and the sampler that turns them into pixels.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <vector>

#include "core/base/vec.h"
#include "core/exemplar/builtin/builtin_patterns.h"

namespace fretwork::drawing {

/// Colour in linear light.
struct Ink {
    float r, g, b;
};

/// \param rgb  0xRRGGBB in sRGB
[[nodiscard]] Ink ink(std::uint32_t rgb);
/// From `a` at t <= 0 to `b` at t >= 1, smoothly.
[[nodiscard]] Ink mix(const Ink& a, const Ink& b, double t);

/// What a pattern shows at one point.
struct Sample {
    double distance;  ///< to the border, px; negative in solid
    Ink color;
};

/// Colours by distance to the border: `solid_rim` turns into `solid_core` `solid_depth` px inside,
/// `hole_rim` into `hole_core` as far outside. Shading by depth rather than by a light keeps a
/// pattern free of directions that synthesis would have to respect.
struct Relief {
    Ink solid_rim, solid_core, hole_rim, hole_core;
    double solid_depth, hole_depth;
};
[[nodiscard]] Sample shade(double distance, const Relief& relief);

/// A canvas that continues across its borders.
struct Torus {
    double width, height;

    /// The shortest way between two points: each coordinate into [-side/2, side/2).
    [[nodiscard]] Vec2 shortest(Vec2 way) const;
};

/// One sample per pixel inside a phase, the mean of 3 x 3 near the border and where colours change quickly. `look` is
/// called from several threads.
PatternPictures draw(int width_px, int height_px, const std::function<Sample(const Vec2&)>& look);

// ---- distances, px; negative inside ------------------------------------------------------------

/// Minimum rounded over a radius of about `k` px: fillets where two shapes meet.
[[nodiscard]] double smooth_min(double a, double b, double k);
/// The same for a list; used to round the corners of polygons. `k` > 0.
[[nodiscard]] double smooth_min(const std::vector<double>& values, double k);
[[nodiscard]] double rounded_box(const Vec2& p, const Vec2& half_size, double corner_radius);
/// Convex regular polygon around the origin; one corner points up if `turn_rad` is 0.
[[nodiscard]] double regular_polygon(const Vec2& p, int sides, double inner_radius, double corner_radius,
                                     double turn_rad);

/// A curved stroke of varying width with round ends.
class Stroke {
  public:
    /// `points` two or more, at most a few px apart; `radius` per point.
    Stroke(std::vector<Vec2> points, std::vector<double> radius);

    /// Distance of `p`, taken to the nearest copy of the stroke on the torus. Exact near the stroke,
    /// a lower bound farther than `kNear` px away, or `most` where that is no more than the distance.
    [[nodiscard]] double distance(const Vec2& p, const Torus& torus,
                                  double most = std::numeric_limits<double>::infinity()) const;

    static constexpr double kNear = 24.0;

  private:
    std::vector<Vec2> points_;
    std::vector<double> radius_;
    /// Segments in a row, with a disc that holds them: most are ruled out by it together.
    struct Run {
        Vec2 center;  ///< from that of the stroke
        double reach;
        std::size_t first, last;  ///< points
    };
    static constexpr std::size_t kRunSegments = 8;
    std::vector<Run> runs_;
    std::vector<double> lengths_;  ///< of the segments
    Vec2 center_;
    double reach_ = 0;   ///< from the centre to the farthest point of the stroke
    double widest_ = 0;  ///< largest radius
};

/// smooth_min of `distance` and that to a stroke.
double joined(double distance, const Stroke& stroke, const Vec2& p, const Torus& torus, double k);

/// Points along a Catmull-Rom spline through `knots`, `steps` per span.
[[nodiscard]] std::vector<Vec2> spline(const std::vector<Vec2>& knots, int steps, bool closed);

// ---- scattered points ---------------------------------------------------------------------------

/// `count` points spread evenly but without order: best of many candidates, then relaxed towards
/// the centres of their Voronoi cells `relaxations` times.
[[nodiscard]] std::vector<Vec2> scatter(const Torus& torus, std::size_t count, int relaxations, std::uint64_t seed);

/// Random number in [0, 1) for `item`, `draw`.
[[nodiscard]] double random_unit(std::uint64_t seed, std::uint64_t item, std::uint32_t draw);

}  // namespace fretwork::drawing
