#include "core/mesh/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <optional>

#include "core/base/parallel.h"
#include "core/mesh/box_tree.h"

namespace fretwork {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;

constexpr std::size_t kGrain = 2048;

Point point(const TriangleMesh& mesh, std::uint32_t v) {
    const Vec3& p = mesh.positions_mm[v];
    return {p[0], p[1], p[2]};
}

/// Decides one pair. Corners are rotated so that what is shared comes first.
class PairTest {
  public:
    PairTest(const TriangleMesh& mesh, JoinedBy joined) : mesh_(mesh), joined_(joined) {}

    [[nodiscard]] bool operator()(std::uint32_t first, std::uint32_t second) const {
        const Triangle &s = mesh_.triangles[first], &t = mesh_.triangles[second];
        int shared = 0;
        std::size_t in_s[3]{}, in_t[3]{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                if (same(s[i], t[j]) && shared < 3) in_s[shared] = i, in_t[shared] = j, ++shared;
        switch (shared) {
            case 0:
                return !apart(s, t, {0, 1, 2}) && !apart(t, s, {0, 1, 2}) &&
                       CGAL::do_intersect(triangle(s), triangle(t));
            case 1:
                return !apart(s, t, {(in_t[0] + 1) % 3, (in_t[0] + 2) % 3}) &&
                       !apart(t, s, {(in_s[0] + 1) % 3, (in_s[0] + 2) % 3}) &&
                       meet_beyond_vertex(s, t, in_s[0], in_t[0]);
            case 2:
                return fold_onto_each_other(s, t, 3 - in_s[0] - in_s[1], 3 - in_t[0] - in_t[1]);
            default:
                return true;
        }
    }

  private:
    [[nodiscard]] bool same(std::uint32_t v, std::uint32_t w) const {
        return v == w || (joined_ == JoinedBy::kPosition && mesh_.positions_mm[v] == mesh_.positions_mm[w]);
    }

    [[nodiscard]] Kernel::Triangle_3 triangle(const Triangle& t) const {
        return {point(mesh_, t[0]), point(mesh_, t[1]), point(mesh_, t[2])};
    }

    /// The named corners of t lie all on one side of the plane of s: the two meet in shared corners at most. Settles
    /// nearly all pairs, at the price of a few signs.
    [[nodiscard]] bool apart(const Triangle& s, const Triangle& t, std::initializer_list<std::size_t> corners) const {
        const Point a = point(mesh_, s[0]), b = point(mesh_, s[1]), c = point(mesh_, s[2]);
        CGAL::Orientation side = CGAL::COPLANAR;
        for (const std::size_t k : corners) {
            const CGAL::Orientation here = CGAL::orientation(a, b, c, point(mesh_, t[k]));
            if (here == CGAL::COPLANAR || (side != CGAL::COPLANAR && here != side)) return false;
            side = here;
        }
        return true;
    }

    /// One vertex in common: they meet elsewhere just if the side across from it of either meets the other.
    [[nodiscard]] bool meet_beyond_vertex(const Triangle& s, const Triangle& t, std::size_t i, std::size_t j) const {
        const Kernel::Segment_3 across_s(point(mesh_, s[(i + 1) % 3]), point(mesh_, s[(i + 2) % 3]));
        const Kernel::Segment_3 across_t(point(mesh_, t[(j + 1) % 3]), point(mesh_, t[(j + 2) % 3]));
        return CGAL::do_intersect(triangle(s), across_t) || CGAL::do_intersect(triangle(t), across_s);
    }

    /// An edge in common: they meet elsewhere just if they lie in one plane on one side of it.
    [[nodiscard]] bool fold_onto_each_other(const Triangle& s, const Triangle& t, std::size_t i, std::size_t j) const {
        const Point a = point(mesh_, s[(i + 1) % 3]), b = point(mesh_, s[(i + 2) % 3]);
        const Point c = point(mesh_, s[i]), d = point(mesh_, t[j]);
        return CGAL::coplanar(a, b, c, d) && CGAL::coplanar_orientation(a, b, c, d) == CGAL::POSITIVE;
    }

    const TriangleMesh& mesh_;
    JoinedBy joined_;
};

Box box_of(const TriangleMesh& mesh, std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    const Vec3 &a = mesh.positions_mm[t[0]], &b = mesh.positions_mm[t[1]], &c = mesh.positions_mm[t[2]];
    return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

bool overlap(const Box& a, const Box& b) {
    return (a.min_mm.array() <= b.max_mm.array()).all() && (b.min_mm.array() <= a.max_mm.array()).all();
}

bool has_area(const TriangleMesh& mesh, std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return !CGAL::collinear(point(mesh, t[0]), point(mesh, t[1]), point(mesh, t[2]));
}

}  // namespace

std::vector<TrianglePair> find_self_intersections_among(const TriangleMesh& mesh, std::span<const std::uint32_t> among,
                                                        const RunControl& run, JoinedBy joined) {
    run.throw_if_stopped();
    std::vector<Box> boxes(among.size());
    std::vector<std::uint8_t> flat(among.size());
    parallel_for(among.size(), kGrain, [&](std::size_t i) {
        boxes[i] = box_of(mesh, among[i]);
        flat[i] = has_area(mesh, among[i]) ? 0 : 1;
    });
    const BoxTree tree(boxes, run);
    std::vector<std::uint8_t> chosen(mesh.triangles.size(), 0);
    for (const std::uint32_t t : among) chosen[t] = 1;

    const PairTest meets(mesh, joined);
    std::vector<std::vector<TrianglePair>> found((mesh.triangles.size() + kGrain - 1) / kGrain);
    parallel_chunks(mesh.triangles.size(), kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        for (std::size_t i = begin; i < end; ++i) {
            const auto t = static_cast<std::uint32_t>(i);
            const Box box = box_of(mesh, t);
            std::optional<bool> counts;  // asked for once something is near
            const double reach = 0.5 * (box.max_mm - box.min_mm).norm();
            tree.near(0.5 * (box.min_mm + box.max_mm), reach, [&](std::uint32_t item) {
                const std::uint32_t other = among[item];
                // A pair of chosen ones comes up twice.
                const bool once = chosen[t] == 0 ? other != t : other < t;
                if (!once || flat[item] != 0 || !overlap(box, boxes[item])) return reach;
                if (!counts) counts = has_area(mesh, t);
                if (*counts && meets(std::min(t, other), std::max(t, other)))
                    found[begin / kGrain].emplace_back(std::min(t, other), std::max(t, other));
                return reach;
            });
        }
    });
    std::vector<TrianglePair> all;
    for (const std::vector<TrianglePair>& part : found) all.insert(all.end(), part.begin(), part.end());
    std::sort(all.begin(), all.end());
    return all;
}

std::vector<TrianglePair> find_self_intersections(const TriangleMesh& mesh, const RunControl& run, JoinedBy joined) {
    std::vector<std::uint32_t> all(mesh.triangles.size());
    std::iota(all.begin(), all.end(), 0U);
    return find_self_intersections_among(mesh, all, run, joined);
}

}  // namespace fretwork
