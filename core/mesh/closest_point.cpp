#include "core/mesh/closest_point.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include "core/base/parallel.h"
#include "core/mesh/box_tree.h"
#include "core/mesh/check_mesh.h"
#include "core/mesh/edge_table.h"
#include "core/mesh/triangle_math.h"
#include "core/mesh/winding_tree.h"

namespace fretwork {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Corners = WindingTree::Corners;

std::vector<Corners> corners_of(const TriangleMesh& mesh) {
    check_mesh(mesh, "surface tree", ZeroArea::kAllowed);
    std::vector<Corners> corners;
    corners.reserve(mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
        corners.push_back({mesh.positions_mm[t[0]], mesh.positions_mm[t[1]], mesh.positions_mm[t[2]]});
    return corners;
}

std::vector<Box> boxes_of(const std::vector<Corners>& corners) {
    std::vector<Box> boxes;
    boxes.reserve(corners.size());
    for (const Corners& t : corners)
        boxes.push_back({t.a.cwiseMin(t.b).cwiseMin(t.c), t.a.cwiseMax(t.b).cwiseMax(t.c)});
    return boxes;
}

/// Every edge is run as often one way as the other: then a ray counts the winding number exactly.
bool bounds_a_volume(const TriangleMesh& mesh, const RunControl& run) {
    const EdgeTable edges(mesh, run);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        int sum = 0;
        for (const HalfEdge h : edges.half_edges(e)) sum += runs_up(mesh, h) ? 1 : -1;
        if (sum != 0) return false;
    }
    return true;
}

}  // namespace

struct SurfaceTree::Impl {
    Impl(const TriangleMesh& mesh, const RunControl& run)
        : corners(corners_of(mesh)), tree(boxes_of(corners), run), closed(bounds_a_volume(mesh, run)) {
        min_mm = max_mm = corners[0].a;
        for (const Corners& t : corners) {
            min_mm = min_mm.cwiseMin(t.a).cwiseMin(t.b).cwiseMin(t.c);
            max_mm = max_mm.cwiseMax(t.a).cwiseMax(t.b).cwiseMax(t.c);
        }
    }

    struct Best {
        Vec3 point = Vec3::Zero();
        double distance2 = kInfinity;
        std::uint32_t triangle = std::numeric_limits<std::uint32_t>::max();
    };

    void consider(const Vec3& p, std::uint32_t t, Best& best) const {
        const Vec3 q = closest_on_triangle(p, corners[t].a, corners[t].b, corners[t].c);
        const double distance2 = (p - q).squaredNorm();
        if (distance2 < best.distance2 || (distance2 == best.distance2 && t < best.triangle)) best = {q, distance2, t};
    }

    /// `hint` names a triangle that is likely near; it saves time and changes nothing.
    [[nodiscard]] ClosestPoint closest(const Vec3& p, double reach, std::uint32_t hint) const {
        Best best;
        if (hint < corners.size()) consider(p, hint, best);
        tree.near(p, std::min(reach, std::sqrt(best.distance2)), [&](std::uint32_t t) {
            consider(p, t, best);
            return std::min(reach, std::sqrt(best.distance2));
        });
        const double distance = std::sqrt(best.distance2);
        if (!(distance <= reach)) return {};
        return {best.point, distance, best.triangle};
    }

    /// Signed crossings of a ray; nothing if it meets an edge exactly.
    [[nodiscard]] std::optional<int> crossings(const Vec3& from, const Vec3& to) const {
        int sum = 0;
        bool doubtful = false;
        tree.along(from, to, [&](std::uint32_t t) {
            const Corners& k = corners[t];
            if (const auto hit = cross_triangle(from, to, k.a, k.b, k.c)) {
                sum += hit->leaving ? 1 : -1;
                doubtful = doubtful || hit->on_edge;
            }
            return 1.0;
        });
        if (doubtful) return std::nullopt;
        return sum;
    }

    std::vector<Corners> corners;
    BoxTree tree;
    bool closed;
    Vec3 min_mm, max_mm;

    /// Made when first asked for: few callers need it.
    [[nodiscard]] const WindingTree& winding() const {
        std::call_once(winding_once_, [this] { winding_.emplace(corners); });
        return *winding_;
    }

  private:
    mutable std::once_flag winding_once_;
    mutable std::optional<WindingTree> winding_;
};

SurfaceTree::SurfaceTree(const TriangleMesh& mesh, const RunControl& run) : impl_(std::make_unique<Impl>(mesh, run)) {}
SurfaceTree::~SurfaceTree() = default;
SurfaceTree::SurfaceTree(SurfaceTree&&) noexcept = default;
SurfaceTree& SurfaceTree::operator=(SurfaceTree&&) noexcept = default;

std::size_t SurfaceTree::triangle_count() const {
    return impl_->corners.size();
}

ClosestPoint SurfaceTree::closest(const Vec3& point_mm, double reach_mm, std::uint32_t hint) const {
    return impl_->closest(point_mm, reach_mm, hint);
}

std::vector<ClosestPoint> SurfaceTree::closest(std::span<const Vec3> points_mm, double reach_mm,
                                               const RunControl& run) const {
    std::vector<ClosestPoint> answers(points_mm.size());
    parallel_chunks(points_mm.size(), 1024, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::uint32_t hint = kNoHint;
        for (std::size_t i = begin; i < end; ++i) {
            answers[i] = impl_->closest(points_mm[i], reach_mm, hint);
            hint = answers[i].triangle;
        }
    });
    return answers;
}

std::optional<SegmentHit> SurfaceTree::first_hit(const Vec3& from_mm, const Vec3& to_mm) const {
    std::optional<SegmentHit> first;
    impl_->tree.along(from_mm, to_mm, [&](std::uint32_t t) {
        const Corners& k = impl_->corners[t];
        if (const auto hit = cross_triangle(from_mm, to_mm, k.a, k.b, k.c))
            if (!first || hit->parameter < first->parameter ||
                (hit->parameter == first->parameter && t < first->triangle))
                first = SegmentHit{hit->parameter, t, hit->leaving};
        return first ? first->parameter : 1.0;
    });
    return first;
}

void SurfaceTree::all_hits(const Vec3& from_mm, const Vec3& to_mm, std::vector<SegmentHit>& hits) const {
    hits.clear();
    impl_->tree.along(from_mm, to_mm, [&](std::uint32_t t) {
        const Corners& k = impl_->corners[t];
        if (const auto hit = cross_triangle(from_mm, to_mm, k.a, k.b, k.c))
            hits.push_back({hit->parameter, t, hit->leaving});
        return 1.0;
    });
    std::sort(hits.begin(), hits.end(), [](const SegmentHit& a, const SegmentHit& b) {
        return a.parameter != b.parameter ? a.parameter < b.parameter : a.triangle < b.triangle;
    });
}

double SurfaceTree::winding_number(const Vec3& point_mm) const {
    return impl_->winding().at(point_mm);
}

bool SurfaceTree::inside(const Vec3& point_mm) const {
    const Impl& s = *impl_;
    if ((point_mm.array() < s.min_mm.array()).any() || (point_mm.array() > s.max_mm.array()).any()) return false;
    if (s.closed) {
        // To the nearest side of the box, slightly askew so that edges along the axes are not met head-on.
        const Vec3 size = s.max_mm - s.min_mm;
        Vec3 to = point_mm + 1e-3 * size.maxCoeff() * Vec3(0.6180339887, 0.4142135624, 0.7320508076);
        int axis = 0;
        double best = kInfinity;
        bool up = true;
        for (int i = 0; i < 3; ++i) {
            const double low = point_mm[i] - s.min_mm[i], high = s.max_mm[i] - point_mm[i];
            if (std::min(low, high) < best) best = std::min(low, high), axis = i, up = high < low;
        }
        const double margin = 0.01 * size.maxCoeff() + 1e-9;
        to[axis] = up ? s.max_mm[axis] + margin : s.min_mm[axis] - margin;
        if (const auto sum = s.crossings(point_mm, to)) return *sum > 0;
    }
    return winding_number(point_mm) > 0.5;
}

double SurfaceTree::signed_distance_mm(const Vec3& point_mm) const {
    const double distance = closest(point_mm).distance_mm;
    return inside(point_mm) ? -distance : distance;
}

}  // namespace fretwork
