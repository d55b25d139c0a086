// Triangles that carry nothing: without width, or given more than once.
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/disjoint_sets.h"
#include "core/mesh/repair_steps.h"
#include "core/mesh/triangle_math.h"

namespace fretwork::repair {
namespace {

/// Passes over chains of flat triangles before what is left of them is dropped as it is.
constexpr int kMostPasses = 32;
/// A side this much shorter than the longest makes a needle, whose ends become one; else the triangle is a cap.
constexpr double kNeedle = 1e-9;

bool names_a_vertex_twice(const Triangle& t) {
    return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

bool flat(const TriangleMesh& mesh, const Triangle& t) {
    return is_degenerate(mesh.positions_mm[t[0]], mesh.positions_mm[t[1]], mesh.positions_mm[t[2]]);
}

/// One pass over the flat triangles, of which those that do not get in each other's way are dealt with.
class FlatPass {
  public:
    explicit FlatPass(Draft& draft)
        : draft_(draft),
          mesh_(draft.mesh),
          edges_(mesh_, draft.run),
          edge_of_(3 * mesh_.triangles.size()),
          touched_(mesh_.triangles.size(), 0),
          drop_(mesh_.triangles.size(), 0),
          merged_(mesh_.positions_mm.size()) {
        for (std::size_t e = 0; e < edges_.size(); ++e)
            for (const HalfEdge h : edges_.half_edges(e)) edge_of_[h] = static_cast<std::uint32_t>(e);
    }

    void run(const std::vector<std::uint32_t>& flat_triangles) {
        for (const std::uint32_t t : flat_triangles) deal_with(t);
        std::vector<std::uint32_t> target(mesh_.positions_mm.size());
        for (std::uint32_t v = 0; v < target.size(); ++v) target[v] = merged_.find(v);
        remap_vertices(draft_, target);
        drop_.resize(mesh_.triangles.size(), 0);
        drop_triangles(draft_, drop_);
    }

  private:
    void deal_with(std::uint32_t t) {
        if (touched_[t] != 0) return;
        std::array<double, 3> length{};
        for (std::uint32_t k = 0; k < 3; ++k)
            length[k] =
                (mesh_.positions_mm[end_of(mesh_, 3 * t + k)] - mesh_.positions_mm[start_of(mesh_, 3 * t + k)]).norm();
        const auto longest =
            static_cast<std::uint32_t>(std::max_element(length.begin(), length.end()) - length.begin());
        const auto shortest =
            static_cast<std::uint32_t>(std::min_element(length.begin(), length.end()) - length.begin());
        if (length[shortest] <= kNeedle * length[longest]) {
            merged_.unite(start_of(mesh_, 3 * t + shortest), end_of(mesh_, 3 * t + shortest));
            drop(t);
            return;
        }
        split_neighbours(t, 3 * t + longest);
    }

    /// Splits what lies across the longest side of a cap at its middle corner, then drops the cap.
    void split_neighbours(std::uint32_t t, HalfEdge longest) {
        const std::uint32_t middle = start_of(mesh_, next_in_triangle(next_in_triangle(longest)));
        const auto neighbours = edges_.half_edges(edge_of_[longest]);
        for (const HalfEdge h : neighbours)
            if (touched_[h / 3] != 0) return;  // next pass
        for (const HalfEdge h : neighbours) {
            touched_[h / 3] = 1;
            if (h / 3 == t) continue;
            Triangle& near = mesh_.triangles[h / 3];
            Triangle far = near;
            far[h % 3] = middle;
            near[next_in_triangle(h) % 3] = middle;
            mesh_.triangles.push_back(far);
            draft_.source.push_back(draft_.source[h / 3]);
        }
        drop(t);
    }

    void drop(std::uint32_t t) {
        touched_[t] = drop_[t] = 1;
        ++draft_.counts.degenerate_triangles;
    }

    Draft& draft_;
    TriangleMesh& mesh_;
    EdgeTable edges_;
    std::vector<std::uint32_t> edge_of_;
    std::vector<std::uint8_t> touched_, drop_;
    DisjointSets merged_;
};

void drop_collapsed(Draft& draft) {
    std::vector<std::uint8_t> drop(draft.mesh.triangles.size(), 0);
    for (std::size_t t = 0; t < drop.size(); ++t)
        if (names_a_vertex_twice(draft.mesh.triangles[t])) {
            drop[t] = 1;
            ++draft.counts.degenerate_triangles;
        }
    drop_triangles(draft, drop);
}

std::vector<std::uint32_t> flat_triangles(const TriangleMesh& mesh, const RunControl& run) {
    std::vector<std::uint32_t> found;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
        if (t % kOften == 0) run.throw_if_stopped();
        if (flat(mesh, mesh.triangles[t])) found.push_back(t);
    }
    return found;
}

/// Vertices ascending, then the triangle; and whether the triangle runs round them the even way.
struct Copy {
    Triangle sorted;
    std::uint32_t triangle;
    bool even;
    bool operator<(const Copy& other) const {
        return sorted != other.sorted ? sorted < other.sorted : triangle < other.triangle;
    }
};

Copy as_copy(const Triangle& t, std::uint32_t index) {
    Copy copy{t, index, true};
    std::sort(copy.sorted.begin(), copy.sorted.end());
    const auto lowest = static_cast<std::size_t>(std::min_element(t.begin(), t.end()) - t.begin());
    copy.even = t[(lowest + 1) % 3] == copy.sorted[1];
    return copy;
}

/// Marks all copies of a triangle but one of the turn that most copies have; of two-sided ones the one kept is noted.
void mark_copies(std::span<const Copy> copies, std::vector<std::uint8_t>& drop, std::vector<std::uint8_t>& two_sided) {
    const auto even =
        static_cast<std::size_t>(std::count_if(copies.begin(), copies.end(), [](auto& c) { return c.even; }));
    const std::size_t odd = copies.size() - even;
    const bool keep_even = even == odd ? copies[0].even : even > odd;
    const auto kept = std::find_if(copies.begin(), copies.end(), [&](auto& c) { return c.even == keep_even; });
    for (auto copy = copies.begin(); copy != copies.end(); ++copy)
        if (copy != kept) drop[copy->triangle] = 1;
    if (even == odd) two_sided[kept->triangle] = 1;
}

/// Two-sided patches between which and the rest every border edge has an even number of other triangles: with the
/// patch gone these still close the surface, so the patch is a wall inside the material.
std::vector<std::uint8_t> inner_walls(const TriangleMesh& mesh, const std::vector<std::uint8_t>& two_sided,
                                      const RunControl& run) {
    const EdgeTable edges(mesh, run);
    DisjointSets patches(mesh.triangles.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto h = edges.half_edges(e);
        if (h.size() == 2 && two_sided[h[0] / 3] != 0 && two_sided[h[1] / 3] != 0) patches.unite(h[0] / 3, h[1] / 3);
    }
    std::vector<double> vote(mesh.triangles.size(), 0.0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto half_edges = edges.half_edges(e);
        const auto others =
            std::count_if(half_edges.begin(), half_edges.end(), [&](HalfEdge h) { return two_sided[h / 3] == 0; });
        if (others == 0 && half_edges.size() > 1) continue;  // between walls: says nothing
        const double length = (mesh.positions_mm[edges.high(e)] - mesh.positions_mm[edges.low(e)]).norm();
        for (const HalfEdge h : half_edges)
            if (two_sided[h / 3] != 0) vote[patches.find(h / 3)] += others > 0 && others % 2 == 0 ? length : -length;
    }
    std::vector<std::uint8_t> wall(mesh.triangles.size(), 0);
    for (std::uint32_t t = 0; t < wall.size(); ++t) wall[t] = two_sided[t] != 0 && vote[patches.find(t)] > 0.0 ? 1 : 0;
    return wall;
}

}  // namespace

void drop_degenerate(Draft& draft) {
    drop_collapsed(draft);
    std::vector<std::uint32_t> found = flat_triangles(draft.mesh, draft.run);
    for (int pass = 0; pass < kMostPasses && !found.empty(); ++pass) {
        FlatPass(draft).run(found);
        drop_collapsed(draft);
        found = flat_triangles(draft.mesh, draft.run);
    }
    std::vector<std::uint8_t> drop(draft.mesh.triangles.size(), 0);
    for (const std::uint32_t t : found) drop[t] = 1;
    draft.counts.degenerate_triangles += found.size();
    drop_triangles(draft, drop);
}

void drop_duplicates(Draft& draft) {
    std::vector<Copy> copies;
    copies.reserve(draft.mesh.triangles.size());
    for (std::uint32_t t = 0; t < draft.mesh.triangles.size(); ++t)
        copies.push_back(as_copy(draft.mesh.triangles[t], t));
    std::sort(copies.begin(), copies.end());
    std::vector<std::uint8_t> drop(copies.size(), 0), two_sided(copies.size(), 0);
    for (std::size_t i = 0; i < copies.size();) {
        std::size_t end = i + 1;
        while (end < copies.size() && copies[end].sorted == copies[i].sorted) ++end;
        if (end - i > 1) mark_copies(std::span(copies).subspan(i, end - i), drop, two_sided);
        i = end;
    }
    const auto dropped = static_cast<std::size_t>(std::count(drop.begin(), drop.end(), 1));
    if (dropped == 0) return;
    draft.counts.duplicate_triangles += dropped;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < drop.size(); ++t)
        if (drop[t] == 0) two_sided[kept++] = two_sided[t];
    two_sided.resize(kept);
    drop_triangles(draft, drop);

    const std::vector<std::uint8_t> wall = inner_walls(draft.mesh, two_sided, draft.run);
    const auto walls = static_cast<std::size_t>(std::count(wall.begin(), wall.end(), 1));
    if (walls == wall.size()) return;
    draft.counts.inner_wall_triangles += 2 * walls;
    draft.counts.duplicate_triangles -= walls;
    drop_triangles(draft, wall);
}

}  // namespace fretwork::repair
