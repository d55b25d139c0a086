#include "core/mesh/self_intersections.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/box_intersection_d.h>

#include <algorithm>
#include <cstddef>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using Pair = std::pair<std::uint32_t, std::uint32_t>;
using TriangleBox = CGAL::Box_intersection_d::Box_with_info_d<double, 3, std::uint32_t>;

constexpr std::size_t kPairsAtOnce = std::size_t{1} << 20;

Point point(const TriangleMesh& mesh, std::uint32_t v) {
    const Vec3& p = mesh.positions_mm[v];
    return {p[0], p[1], p[2]};
}

/// Decides one pair. Corners are rotated so that what is shared comes first.
class PairTest {
  public:
    PairTest(const TriangleMesh& mesh, JoinedBy joined) : mesh_(mesh), joined_(joined) {}

    [[nodiscard]] bool operator()(const Pair& pair) const {
        const Triangle &s = mesh_.triangles[pair.first], &t = mesh_.triangles[pair.second];
        int shared = 0;
        std::size_t in_s[3]{}, in_t[3]{};
        for (std::size_t i = 0; i < 3; ++i)
            for (std::size_t j = 0; j < 3; ++j)
                if (same(s[i], t[j]) && shared < 3) in_s[shared] = i, in_t[shared] = j, ++shared;
        switch (shared) {
            case 0:
                return CGAL::do_intersect(triangle(s), triangle(t));
            case 1:
                return meet_beyond_vertex(s, t, in_s[0], in_t[0]);
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

std::vector<TriangleBox> boxes_of(const TriangleMesh& mesh) {
    std::vector<TriangleBox> boxes;
    boxes.reserve(mesh.triangles.size());
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        const Point a = point(mesh, t[0]), b = point(mesh, t[1]), c = point(mesh, t[2]);
        if (!CGAL::collinear(a, b, c)) boxes.emplace_back(a.bbox() + b.bbox() + c.bbox(), i);
    }
    return boxes;
}

}  // namespace

std::vector<Pair> find_self_intersections(const TriangleMesh& mesh, const RunControl& run, JoinedBy joined) {
    std::vector<TriangleBox> boxes = boxes_of(mesh);
    std::vector<Pair> candidates, found;
    const PairTest meets(mesh, joined);
    // Candidates come from one thread, in batches that are decided by all.
    const auto decide = [&] {
        std::vector<std::uint8_t> yes(candidates.size());
        parallel_chunks(candidates.size(), 4096, [&](std::size_t begin, std::size_t end) {
            run.throw_if_stopped();
            for (std::size_t i = begin; i < end; ++i) yes[i] = meets(candidates[i]) ? 1 : 0;
        });
        for (std::size_t i = 0; i < candidates.size(); ++i)
            if (yes[i] != 0) found.push_back(candidates[i]);
        candidates.clear();
    };
    run.throw_if_stopped();
    CGAL::box_self_intersection_d(boxes.begin(), boxes.end(), [&](const TriangleBox& a, const TriangleBox& b) {
        candidates.emplace_back(std::minmax(a.info(), b.info()));
        if (candidates.size() % 4096 == 0) run.throw_if_stopped();
        if (candidates.size() >= kPairsAtOnce) decide();
    });
    decide();
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
}

}  // namespace fretwork
