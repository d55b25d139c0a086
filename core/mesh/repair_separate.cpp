// Index manifoldness: one vertex per fan, one edge per glued pair.
#include <algorithm>

#include "core/base/disjoint_sets.h"
#include "core/mesh/repair_steps.h"

namespace fretwork::repair {
namespace {

void split_fans(Draft& draft, const std::vector<HalfEdge>& mates) {
    TriangleMesh& mesh = draft.mesh;
    DisjointSets fans(mates.size());  // corner c = the half-edge that starts there
    for (HalfEdge h = 0; h < mates.size(); ++h) {
        if (h % kOften == 0) draft.run.throw_if_stopped();
        if (const HalfEdge g = mates[h]; g != kNoMate && h < g) {
            fans.unite(h, next_in_triangle(g));
            fans.unite(next_in_triangle(h), g);
        }
    }
    std::vector<std::uint8_t> taken(mesh.positions_mm.size(), 0);
    std::vector<std::uint32_t> vertex_of(mates.size());
    for (HalfEdge c = 0; c < mates.size(); ++c) {
        std::uint32_t& v = mesh.triangles[c / 3][c % 3];
        if (const std::uint32_t fan = fans.find(c); fan != c) {
            v = vertex_of[fan];
            continue;
        }
        if (taken[v] != 0) {
            mesh.positions_mm.push_back(Vec3(mesh.positions_mm[v]));
            v = static_cast<std::uint32_t>(mesh.positions_mm.size() - 1);
            ++draft.counts.split_vertices;
        } else {
            taken[v] = 1;
        }
        vertex_of[c] = v;
    }
}

/// A surface that touches itself along an edge may use both ends in one fan each and still pass through the edge
/// twice. Such a passage gets a vertex of its own in the middle of the edge.
class EdgeSplitter {
  public:
    EdgeSplitter(Draft& draft, std::vector<HalfEdge> mates) : draft_(draft), mates_(std::move(mates)) {}

    void run() {
        while (pass()) {
        }
    }

  private:
    bool pass() {
        const EdgeTable edges(draft_.mesh, draft_.run);
        std::vector<std::uint8_t> touched(draft_.mesh.triangles.size(), 0);
        // Triangles that this pass made are unknown to `edges` and to `touched`: they wait for the next pass.
        const auto waits = [&](HalfEdge half) { return half / 3 >= touched.size() || touched[half / 3] != 0; };
        bool again = false;
        for (std::size_t e = 0; e < edges.size(); ++e) {
            const auto half_edges = edges.half_edges(e);
            const HalfEdge keeper = half_edges[0];
            for (const HalfEdge h : half_edges) {
                const HalfEdge g = mates_[h];
                if (h == keeper || g == keeper || (g != kNoMate && g < h)) continue;
                again = true;
                if (waits(h) || (g != kNoMate && waits(g))) continue;
                touched[h / 3] = 1;
                if (g != kNoMate) touched[g / 3] = 1;
                split(h, g);
            }
        }
        return again;
    }

    void split(HalfEdge h, HalfEdge g) {
        TriangleMesh& mesh = draft_.mesh;
        const auto middle = static_cast<std::uint32_t>(mesh.positions_mm.size());
        mesh.positions_mm.push_back(0.5 * (mesh.positions_mm[start_of(mesh, h)] + mesh.positions_mm[end_of(mesh, h)]));
        ++draft_.counts.split_vertices;
        const HalfEdge h_far = split_triangle(h, middle);
        if (g == kNoMate) {
            mates_[h] = mates_[h_far] = kNoMate;
            return;
        }
        const HalfEdge g_far = split_triangle(g, middle);
        mates_[h] = g_far, mates_[g_far] = h;
        mates_[g] = h_far, mates_[h_far] = g;
    }

    /// Triangle (s, e, d) with h from s to e becomes (s, m, d), in place, and (m, e, d). \return half-edge m -> e
    HalfEdge split_triangle(HalfEdge h, std::uint32_t middle) {
        TriangleMesh& mesh = draft_.mesh;
        const HalfEdge n = next_in_triangle(h);
        const std::uint32_t end = mesh.triangles[h / 3][n % 3], apex = mesh.triangles[h / 3][next_in_triangle(n) % 3];
        const auto fresh = static_cast<HalfEdge>(3 * mesh.triangles.size());
        mesh.triangles[h / 3][n % 3] = middle;
        mesh.triangles.push_back({middle, end, apex});
        draft_.source.push_back(draft_.source[h / 3]);
        const HalfEdge beyond = mates_[n];
        mates_.insert(mates_.end(), {kNoMate, beyond, n});
        if (beyond != kNoMate) mates_[beyond] = fresh + 1;
        mates_[n] = fresh + 2;
        return fresh;
    }

    Draft& draft_;
    std::vector<HalfEdge> mates_;
};

}  // namespace

void separate_sheets(Draft& draft, std::vector<HalfEdge> mates) {
    split_fans(draft, mates);
    EdgeSplitter(draft, std::move(mates)).run();
}

}  // namespace fretwork::repair
