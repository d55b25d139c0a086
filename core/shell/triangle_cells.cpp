#include "core/shell/triangle_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

// Cells are cut out of a triangle a little larger than they are, so that no cell is missed by rounding;
// the separating-axis test has the last word on those that are touched only by the widened part.
constexpr double kWiden = 1e-7;
// A patch with its middle this far inside a cell needs no further test.
constexpr double kClearlyInside = 1e-6;

// A triangle cut by the six planes of a cube has at most nine corners.
struct Polygon {
    int size = 0;
    std::array<std::array<double, 3>, 10> corner;
};

using Point = std::array<double, 3>;

template <std::size_t Axis>
Point point_at(const Point& a, const Point& b, double at) {
    const double t = (at - a[Axis]) / (b[Axis] - a[Axis]);
    Point p;
    for (std::size_t k = 0; k < 3; ++k) p[k] = a[k] + t * (b[k] - a[k]);
    p[Axis] = at;
    return p;
}

enum class Side { kBelow, kAbove };

// Sutherland-Hodgman against one plane: keeps what lies on one side of `at`.
template <std::size_t Axis, Side Kept>
void cut_by_plane(const Polygon& in, double at, Polygon& out) {
    const auto keeps = [at](const Point& p) { return Kept == Side::kBelow ? p[Axis] <= at : p[Axis] >= at; };
    const Point* p = in.corner.data();
    const Point* const first = p;
    const Point* const end = p + in.size;
    Point* to = out.corner.data();
    for (bool keeps_p = in.size > 0 && keeps(*p); p != end; ++p) {
        const Point& q = p + 1 == end ? *first : p[1];
        const bool keeps_q = keeps(q);
        *to = *p;
        to += keeps_p ? 1 : 0;
        if (keeps_p != keeps_q) *to++ = point_at<Axis>(*p, q, at);
        keeps_p = keeps_q;
    }
    out.size = static_cast<int>(to - out.corner.data());
}

struct Range {
    double low;
    double high;
};

template <std::size_t Axis>
Range range_along(const Polygon& polygon) {
    Range range = {polygon.corner[0][Axis], polygon.corner[0][Axis]};
    for (int i = 1; i < polygon.size; ++i) {
        const double x = polygon.corner[static_cast<std::size_t>(i)][Axis];
        range.low = std::min(range.low, x);
        range.high = std::max(range.high, x);
    }
    return range;
}

// Room for the two steps of cutting one layer out of a polygon.
struct LayerCut {
    Polygon below;
    Polygon between;
};

// The part of `in` between the planes of layer `cell`, widened; `in` itself where nothing is cut off.
template <std::size_t Axis>
const Polygon& cut_to_layer(const Polygon& in, const Range& range, int cell, LayerCut& cut) {
    const double low = cell - kWiden;
    const double high = cell + 1 + kWiden;
    const Polygon* part = &in;
    if (range.high > high) {
        cut_by_plane<Axis, Side::kBelow>(*part, high, cut.below);
        part = &cut.below;
    }
    if (range.low < low) {
        cut_by_plane<Axis, Side::kAbove>(*part, low, cut.between);
        part = &cut.between;
    }
    return *part;
}

int first_layer(const Range& range, int lowest) {
    return std::max(lowest, static_cast<int>(std::floor(range.low - kWiden)));
}

int past_last_layer(const Range& range, int highest) {
    return std::min(highest, static_cast<int>(std::floor(range.high + kWiden)) + 1);
}

Vec3 as_vector(const Point& p) {
    return {p[0], p[1], p[2]};
}

struct PolygonArea {
    double area = 0.0;
    Vec3 centroid = Vec3::Zero();  // where there is an area
};

PolygonArea measure(const Polygon& polygon, const Vec3& normal) {
    const Vec3 origin = as_vector(polygon.corner[0]);
    double twice = 0.0;
    Vec3 moment = Vec3::Zero();
    for (int i = 2; i < polygon.size; ++i) {
        const Vec3 a = as_vector(polygon.corner[static_cast<std::size_t>(i - 1)]) - origin;
        const Vec3 b = as_vector(polygon.corner[static_cast<std::size_t>(i)]) - origin;
        const double part = a.cross(b).dot(normal);
        twice += part;
        moment += part * (a + b);
    }
    if (!(twice > 0.0)) return {};
    return {0.5 * twice, origin + moment / (3.0 * twice)};
}

// Point of a convex polygon closest to the origin of its coordinates.
Vec3 closest_to_origin(const Polygon& polygon, const Vec3& center, const Vec3& normal) {
    const Vec3 foot = normal * normal.dot(as_vector(polygon.corner[0]) - center);
    const bool has_normal = normal != Vec3::Zero();
    bool inside = has_normal;
    Vec3 best = as_vector(polygon.corner[0]) - center;
    double best_squared = best.squaredNorm();
    for (int i = 0; i < polygon.size; ++i) {
        const Vec3 a = as_vector(polygon.corner[static_cast<std::size_t>(i)]) - center;
        const Vec3 b = as_vector(polygon.corner[static_cast<std::size_t>(i + 1 == polygon.size ? 0 : i + 1)]) - center;
        const Vec3 ab = b - a;
        if (has_normal && normal.dot(ab.cross(foot - a)) >= 0.0) continue;  // the foot is on the inner side
        inside = false;
        const double squared_length = ab.squaredNorm();
        const double t = squared_length > 0.0 ? std::clamp(-a.dot(ab) / squared_length, 0.0, 1.0) : 0.0;
        const Vec3 p = a + t * ab;
        if (p.squaredNorm() < best_squared) {
            best = p;
            best_squared = p.squaredNorm();
        }
    }
    return inside ? foot : best;
}

// Both cells beside a face list a patch that lies in the face, and each takes half of its area.
double share_of_area(const Polygon& polygon, const VoxelCoord& cell) {
    const std::array<Range, 3> ranges = {range_along<0>(polygon), range_along<1>(polygon), range_along<2>(polygon)};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double low = cell[axis];
        if (ranges[axis].high - low <= kWiden || low + 1.0 - ranges[axis].low <= kWiden) return 0.5;
    }
    return 1.0;
}

class TriangleCutter {
  public:
    TriangleCutter(const Corners& triangle, const Vec3& normal, std::uint32_t index, int extent_x,
                   std::vector<Patch>& patches)
        : triangle_(triangle), normal_(normal), index_(index), extent_x_(extent_x), patches_(patches) {}

    void add_if_met(const Polygon& part, const VoxelCoord& cell) {
        if (part.size == 0) return;
        const Vec3 center(cell[0] + 0.5, cell[1] + 0.5, cell[2] + 0.5);
        Vec3 middle = Vec3::Zero();
        for (int i = 0; i < part.size; ++i) middle += as_vector(part.corner[static_cast<std::size_t>(i)]);
        middle = middle / part.size - center;
        const bool clearly = middle.cwiseAbs().maxCoeff() < 0.5 - kClearlyInside;
        if (!clearly && !triangle_meets_cell(triangle_, center)) return;
        PolygonArea measured = measure(part, normal_);
        if (!clearly) measured.area *= share_of_area(part, cell);
        const Vec3f closest = closest_to_origin(part, center, normal_).cast<float>();
        const Vec3f centroid = measured.area > 0.0 ? Vec3f((measured.centroid - center).cast<float>()) : closest;
        patches_.push_back({static_cast<std::uint32_t>(cell[2]),
                            static_cast<std::uint32_t>(cell[1] * extent_x_ + cell[0]), index_,
                            static_cast<float>(measured.area), closest, centroid});
    }

  private:
    const Corners& triangle_;
    Vec3 normal_;
    std::uint32_t index_;
    int extent_x_;
    std::vector<Patch>& patches_;
};

}  // namespace

GriddedMesh lay_into_grid(const TriangleMesh& mesh, const VoxelGrid& grid) {
    GriddedMesh laid;
    laid.triangles = mesh.triangles;
    laid.points.resize(mesh.positions_mm.size());
    laid.normals.resize(mesh.triangles.size());
    parallel_for(laid.points.size(), 8192,
                 [&](std::size_t p) { laid.points[p] = (mesh.positions_mm[p] - grid.origin_mm) / grid.voxel_mm; });
    parallel_for(laid.normals.size(), 8192, [&](std::size_t t) {
        const Corners c = laid.corners(static_cast<std::uint32_t>(t));
        const Vec3 n = (c[1] - c[0]).cross(c[2] - c[0]);
        const double length = n.norm();
        laid.normals[t] = length > 0.0 ? Vec3(n / length) : Vec3::Zero();
    });
    return laid;
}

bool segment_meets_cell(const Vec3& a, const Vec3& b, const Vec3& center) {
    constexpr double half = 0.5 + kTouchVoxels;
    const Vec3 middle = 0.5 * (a + b) - center;
    const Vec3 reach = 0.5 * (b - a);
    for (int k = 0; k < 3; ++k)
        if (std::abs(middle[k]) > half + std::abs(reach[k])) return false;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 1) % 3;
        const int j = (k + 2) % 3;
        const double distance = std::abs(middle[i] * reach[j] - middle[j] * reach[i]);
        if (distance > half * (std::abs(reach[i]) + std::abs(reach[j]))) return false;
    }
    return true;
}

bool triangle_meets_cell(const Corners& triangle, const Vec3& center) {
    constexpr double half = 0.5 + kTouchVoxels;
    const Corners v = {triangle[0] - center, triangle[1] - center, triangle[2] - center};
    for (int k = 0; k < 3; ++k) {
        if (std::min({v[0][k], v[1][k], v[2][k]}) > half) return false;
        if (std::max({v[0][k], v[1][k], v[2][k]}) < -half) return false;
    }

    const Corners edge = {v[1] - v[0], v[2] - v[1], v[0] - v[2]};
    for (std::size_t e = 0; e < 3; ++e) {
        // Along edge x axis the two ends of the edge fall on one value; the third corner gives the other.
        const Vec3& on = v[e];
        const Vec3& off = v[(e + 2) % 3];
        for (int k = 0; k < 3; ++k) {
            const int i = (k + 1) % 3;
            const int j = (k + 2) % 3;
            const double p = on[i] * edge[e][j] - on[j] * edge[e][i];
            const double q = off[i] * edge[e][j] - off[j] * edge[e][i];
            const double radius = half * (std::abs(edge[e][i]) + std::abs(edge[e][j]));
            if (std::min(p, q) > radius || std::max(p, q) < -radius) return false;
        }
    }

    // The normal of a needle is mostly rounding. The slack is a bound of that rounding, so that for needles
    // this axis gives way to the others, which stay accurate.
    const Vec3 normal = edge[0].cross(edge[1]);
    const double slack =
        16.0 * std::numeric_limits<double>::epsilon() * edge[0].lpNorm<1>() * edge[1].lpNorm<1>() * v[0].lpNorm<1>();
    return std::abs(normal.dot(v[0])) <= half * normal.lpNorm<1>() + slack;
}

void cut_triangle(const GriddedMesh& mesh, std::uint32_t index, const VoxelCoord& extent, int z_begin, int z_end,
                  std::vector<Patch>& patches, const RunControl& run) {
    const Corners triangle = mesh.corners(index);
    TriangleCutter cutter(triangle, mesh.normals[index], index, extent[0], patches);
    Polygon whole;
    whole.size = 3;
    for (std::size_t c = 0; c < 3; ++c) whole.corner[c] = {triangle[c][0], triangle[c][1], triangle[c][2]};

    LayerCut z_cut;
    LayerCut y_cut;
    LayerCut x_cut;
    const Range z_range = range_along<2>(whole);
    for (int z = first_layer(z_range, z_begin); z < past_last_layer(z_range, z_end); ++z) {
        const Polygon& layer = cut_to_layer<2>(whole, z_range, z, z_cut);
        if (layer.size == 0) continue;
        const Range y_range = range_along<1>(layer);
        for (int y = first_layer(y_range, 0); y < past_last_layer(y_range, extent[1]); ++y) {
            run.throw_if_stopped();
            const Polygon& row = cut_to_layer<1>(layer, y_range, y, y_cut);
            if (row.size == 0) continue;
            const Range x_range = range_along<0>(row);
            for (int x = first_layer(x_range, 0); x < past_last_layer(x_range, extent[0]); ++x)
                cutter.add_if_met(cut_to_layer<0>(row, x_range, x, x_cut), {x, y, z});
        }
    }
}

}  // namespace fretwork
