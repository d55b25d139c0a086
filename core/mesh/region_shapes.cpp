#include "core/mesh/region_shapes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/mesh/closest_point.h"
#include "core/mesh/edge_table.h"
#include "core/mesh/repair.h"
#include "core/mesh/segment_tree.h"
#include "core/mesh/sharp_edges.h"
#include "core/mesh/triangle_math.h"

namespace fretwork::regions {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

[[noreturn]] void refuse(const Region& region, const std::string& what) {
    throw InvalidSetting("region '" + region.name + "': " + what);
}

void need(bool good, const Region& region, const std::string& what) {
    if (!good) refuse(region, what);
}

void need_positive(double value, const char* key, const Region& region) {
    need(std::isfinite(value) && value > 0.0, region,
         std::string(key) + " is " + std::to_string(value) + "; expected a length above 0 mm");
}

void need_finite(const Vec3& v, const char* key, const Region& region) {
    need(v.allFinite(), region, std::string(key) + " holds a number that is not finite");
}

/// Distance to a set given by its distances along independent directions: outside the corner counts, inside the
/// nearest side.
double combine(double u, double v) {
    return std::hypot(std::max(u, 0.0), std::max(v, 0.0)) + std::min(std::max(u, v), 0.0);
}

double distance_to(const BoxRegion& box, const Vec3& p) {
    const Vec3 out = (box.min_mm - p).cwiseMax(p - box.max_mm);
    return out.cwiseMax(0.0).norm() + std::min(out.maxCoeff(), 0.0);
}
double distance_to(const SphereRegion& sphere, const Vec3& p) {
    return (p - sphere.center_mm).norm() - sphere.radius_mm;
}
double distance_to(const CylinderRegion& cylinder, const Vec3& p) {
    const Vec3 axis = cylinder.to_mm - cylinder.from_mm;
    const double length = axis.norm();
    const double along = (p - cylinder.from_mm).dot(axis) / length;
    const double from_axis = (p - cylinder.from_mm - along / length * axis).norm();
    return combine(from_axis - cylinder.radius_mm, std::max(-along, along - length));
}
double distance_to(const HalfSpaceRegion& half_space, const Vec3& p) {
    return (p - half_space.point_mm).dot(half_space.outward) / half_space.outward.norm();
}
double distance_to(const PlaneBandRegion& band, const Vec3& p) {
    return std::abs((p - band.point_mm).dot(band.normal)) / band.normal.norm() - band.half_width_mm;
}

void check(const BoxRegion& box, const Region& region) {
    need_finite(box.min_mm, "min", region);
    need_finite(box.max_mm, "max", region);
    for (int axis = 0; axis < 3; ++axis)
        need(box.min_mm[axis] < box.max_mm[axis], region,
             std::string("the box is empty: min ") + "xyz"[axis] + " is " + std::to_string(box.min_mm[axis]) +
                 " and max is " + std::to_string(box.max_mm[axis]));
}
void check(const SphereRegion& sphere, const Region& region) {
    need_finite(sphere.center_mm, "center", region);
    need_positive(sphere.radius_mm, "radius", region);
}
void check(const CylinderRegion& cylinder, const Region& region) {
    need_finite(cylinder.from_mm, "from", region);
    need_finite(cylinder.to_mm, "to", region);
    need((cylinder.to_mm - cylinder.from_mm).norm() > 0.0, region,
         "the cylinder has no length: from and to are one point");
    need_positive(cylinder.radius_mm, "radius", region);
}
void check(const HalfSpaceRegion& half_space, const Region& region) {
    need_finite(half_space.point_mm, "point", region);
    need_finite(half_space.outward, "outward", region);
    need(half_space.outward.norm() > 0.0, region, "outward is the zero vector; expected a direction");
}
void check(const PlaneBandRegion& band, const Region& region) {
    need_finite(band.point_mm, "point", region);
    need_finite(band.normal, "normal", region);
    need(band.normal.norm() > 0.0, region, "normal is the zero vector; expected a direction");
    need_positive(band.half_width_mm, "half width", region);
}

template <class Solid>
class SolidShape : public Shape {
  public:
    explicit SolidShape(const Solid& solid) : solid_(solid) {}
    [[nodiscard]] double signed_distance_mm(const Vec3& p, std::uint32_t) const override {
        return distance_to(solid_, p);
    }

  private:
    Solid solid_;
};

/// Within a distance of edges of the mesh.
class NearEdges : public Shape {
  public:
    NearEdges(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges, double half_width_mm)
        : tree_(segments(mesh, edges)), half_width_mm_(half_width_mm) {}
    [[nodiscard]] double signed_distance_mm(const Vec3& p, std::uint32_t) const override {
        return tree_.distance_mm(p) - half_width_mm_;
    }

    static std::vector<Segment> segments(const TriangleMesh& mesh, const std::vector<MeshEdge>& edges) {
        std::vector<Segment> all;
        for (const MeshEdge& e : edges) all.emplace_back(mesh.positions_mm[e.low], mesh.positions_mm[e.high]);
        return all;
    }

  private:
    SegmentTree tree_;
    double half_width_mm_;
};

/// A set of triangles: the distance to the edges where it ends, the sign by membership.
class TriangleSet : public Shape {
  public:
    TriangleSet(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles)
        : member_(members(mesh, triangles)), rim_(rim(mesh, member_)) {}
    [[nodiscard]] double signed_distance_mm(const Vec3& p, std::uint32_t triangle) const override {
        const double distance = rim_.distance_mm(p);
        return member_[triangle] != 0 ? -distance : distance;
    }

  private:
    static std::vector<std::uint8_t> members(const TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
        std::vector<std::uint8_t> member(mesh.triangles.size(), 0);
        for (const std::uint32_t t : triangles) member[t] = 1;
        return member;
    }
    static std::vector<Segment> rim(const TriangleMesh& mesh, const std::vector<std::uint8_t>& member) {
        std::vector<Segment> segments;
        const EdgeTable edges(mesh);
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const auto half_edges = edges.half_edges(e);
            const bool first = member[half_edges[0] / 3] != 0;
            if (std::any_of(half_edges.begin(), half_edges.end(),
                            [&](HalfEdge h) { return (member[h / 3] != 0) != first; }))
                segments.emplace_back(mesh.positions_mm[edges.low(e)], mesh.positions_mm[edges.high(e)]);
        }
        return segments;
    }

    std::vector<std::uint8_t> member_;
    SegmentTree rim_;
};

/// How far a volume reaches beyond its surface, so that what lies on it is inside: far below what can be printed, far
/// above the rounding of coordinates in files.
constexpr double kTouchMm = 0.01;

/// What lies inside a closed surface, or on it.
class Volume : public Shape {
  public:
    explicit Volume(SurfaceTree tree) : tree_(std::move(tree)) {}
    [[nodiscard]] double signed_distance_mm(const Vec3& p, std::uint32_t) const override {
        return tree_.signed_distance_mm(p) - kTouchMm;
    }

  private:
    SurfaceTree tree_;
};

bool any_edge_hits(const TriangleMesh& mesh, const SurfaceTree& tree) {
    return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
        for (std::size_t k = 0; k < 3; ++k)
            if (tree.first_hit(mesh.positions_mm[t[k]], mesh.positions_mm[t[(k + 1) % 3]])) return true;
        return false;
    });
}

/// Either a vertex of one lies within the other, or an edge of one passes through the other.
bool volume_meets(const TriangleMesh& volume, const SurfaceTree& volume_tree, const TriangleMesh& mesh) {
    const auto inside = [&](const Vec3& p) { return volume_tree.signed_distance_mm(p) <= kTouchMm; };
    if (std::any_of(mesh.positions_mm.begin(), mesh.positions_mm.end(), inside)) return true;
    if (any_edge_hits(mesh, volume_tree)) return true;
    const SurfaceTree mesh_tree(mesh);
    const auto touches = [&](const Vec3& p) { return mesh_tree.closest(p, 2.0 * kTouchMm).distance_mm <= kTouchMm; };
    return std::any_of(volume.positions_mm.begin(), volume.positions_mm.end(), touches) ||
           any_edge_hits(volume, mesh_tree);
}

class Everywhere : public Shape {
  public:
    [[nodiscard]] double signed_distance_mm(const Vec3&, std::uint32_t) const override { return -kInfinity; }
};

/// Makes the shape of each kind of region.
struct Preparer {
    const TriangleMesh& mesh;
    const Region& region;
    using Result = std::unique_ptr<Shape>;

    template <class Solid>
    Result operator()(const Solid& solid) const {
        check(solid, region);
        const bool any = std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const Triangle& t) {
            return meets(solid, mesh.positions_mm[t[0]], mesh.positions_mm[t[1]], mesh.positions_mm[t[2]]);
        });
        need(any, region, "meets no part of the surface");
        return std::make_unique<SolidShape<Solid>>(solid);
    }
    Result operator()(const SharpEdgeRegion& sharp) const {
        need(sharp.min_angle_deg >= 0.0 && sharp.min_angle_deg <= 180.0, region,
             "min angle is " + std::to_string(sharp.min_angle_deg) + " degrees; expected 0 to 180");
        need_positive(sharp.half_width_mm, "half width", region);
        const std::vector<MeshEdge> edges = sharp_edges(mesh, sharp.min_angle_deg);
        need(!edges.empty(), region,
             "meets no part of the surface: no edge is folded by more than " + std::to_string(sharp.min_angle_deg) +
                 " degrees");
        return std::make_unique<NearEdges>(mesh, edges, sharp.half_width_mm);
    }
    Result operator()(const OpenBorderRegion& border) const {
        need_positive(border.half_width_mm, "half width", region);
        const std::vector<MeshEdge> edges = border_edges(mesh);
        need(!edges.empty(), region, "meets no part of the surface: it is closed and has no border");
        return std::make_unique<NearEdges>(mesh, edges, border.half_width_mm);
    }
    Result operator()(const TriangleSetRegion& set) const {
        need(!set.triangles.empty(), region, "meets no part of the surface: it names no triangle");
        for (const std::uint32_t t : set.triangles)
            need(t < mesh.triangles.size(), region,
                 "names triangle " + std::to_string(t) + ", but the mesh has " + std::to_string(mesh.triangles.size()) +
                     " triangles");
        return std::make_unique<TriangleSet>(mesh, set.triangles);
    }
    Result operator()(const NamedRegion&) const {
        need(false, region, "names faces or parts, and this mesh has none");
        return nullptr;
    }
    Result operator()(const LowestRegion& lowest) const {
        need(lowest.share > 0.0 && lowest.share <= 1.0, region,
             "share is " + std::to_string(lowest.share) + "; expected more than 0 and at most 1");
        double low = kInfinity, high = -kInfinity;
        for (const Triangle& t : mesh.triangles)
            for (const std::uint32_t v : t) {
                low = std::min(low, mesh.positions_mm[v][2]);
                high = std::max(high, mesh.positions_mm[v][2]);
            }
        if (lowest.share == 1.0) return std::make_unique<Everywhere>();
        const HalfSpaceRegion below{Vec3(0.0, 0.0, low + lowest.share * (high - low)), Vec3::UnitZ()};
        return std::make_unique<SolidShape<HalfSpaceRegion>>(below);
    }
    Result operator()(const EverywhereRegion&) const { return std::make_unique<Everywhere>(); }
    Result operator()(const VolumeRegion& volume) const {
        need(!volume.surface.triangles.empty(), region, "has no triangle");
        for (const Vec3& p : volume.surface.positions_mm) need_finite(p, "vertices", region);
        for (const Triangle& t : volume.surface.triangles)
            for (const std::uint32_t v : t)
                need(v < volume.surface.positions_mm.size(), region,
                     "a triangle names vertex " + std::to_string(v) + ", and there are " +
                         std::to_string(volume.surface.positions_mm.size()));
        const RepairedMesh repaired = repair_mesh(volume.surface);
        need(repaired.counts.border_edges == 0, region,
             "its surface is not closed: " + std::to_string(repaired.counts.border_edges) +
                 " edges have a triangle on one side only");
        SurfaceTree tree(repaired.mesh);
        need(volume_meets(repaired.mesh, tree, mesh), region, "meets no part of the surface");
        return std::make_unique<Volume>(std::move(tree));
    }
};

}  // namespace

std::unique_ptr<Shape> prepare(const TriangleMesh& mesh, const Region& region) {
    return std::visit(Preparer{mesh, region}, region.shape);
}

}  // namespace fretwork::regions
