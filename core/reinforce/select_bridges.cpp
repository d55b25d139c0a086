#include "core/reinforce/select_bridges.h"

#include <algorithm>

namespace fretwork {

EdgePlaces edge_places(const SurfaceVoxels& shell, const AbstractGraph& graph) {
    EdgePlaces places;
    places.middle_mm.reserve(graph.edges.size());
    places.length_mm.reserve(graph.edges.size());
    for (const AbstractEdge& edge : graph.edges) {
        const Vec3& a = shell.points_mm[graph.samples[edge.a]];
        const Vec3& b = shell.points_mm[graph.samples[edge.b]];
        places.middle_mm.emplace_back(0.5 * (a + b));
        places.length_mm.push_back(static_cast<double>(edge.length_voxels) * shell.grid.voxel_mm);
    }
    return places;
}

std::vector<EdgeIndex> select_bridges(const EdgePlaces& places, std::span<const double> scores,
                                      std::span<const EdgeIndex> candidates, std::size_t most, double cancel_factor,
                                      const std::function<bool(EdgeIndex)>& wanted) {
    std::vector<EdgeIndex> by_score(candidates.begin(), candidates.end());
    std::ranges::sort(by_score,
                      [&](EdgeIndex x, EdgeIndex y) { return scores[x] != scores[y] ? scores[x] > scores[y] : x < y; });
    std::vector<EdgeIndex> taken;
    for (const EdgeIndex e : by_score) {
        if (taken.size() >= most) break;
        const bool cancelled = std::ranges::any_of(taken, [&](EdgeIndex t) {
            return (places.middle_mm[t] - places.middle_mm[e]).norm() < cancel_factor * places.length_mm[t];
        });
        if (cancelled || (wanted && !wanted(e))) continue;
        taken.push_back(e);
    }
    return taken;
}

DisjointSets solid_pieces(const AbstractGraph& graph, std::span<const EdgeState> states) {
    DisjointSets pieces(graph.samples.size());
    for (EdgeIndex e = 0; e < graph.edges.size(); ++e)
        if (states[e] == EdgeState::kSolid) pieces.unite(graph.edges[e].a, graph.edges[e].b);
    return pieces;
}

std::vector<EdgeIndex> select_connections(const AbstractGraph& graph, std::span<const EdgeState> states,
                                          const EdgePlaces& places, std::span<const double> scores,
                                          double cancel_factor) {
    DisjointSets pieces = solid_pieces(graph, states);
    std::vector<EdgeIndex> candidates;
    for (EdgeIndex e = 0; e < graph.edges.size(); ++e)
        if (pieces.find(graph.edges[e].a) != pieces.find(graph.edges[e].b)) candidates.push_back(e);
    return select_bridges(places, scores, candidates, candidates.size(), cancel_factor,
                          [&](EdgeIndex e) { return pieces.unite(graph.edges[e].a, graph.edges[e].b); });
}

}  // namespace fretwork
