#include "core/solidify/collapse_mesh.h"

#include <algorithm>

#include "core/base/parallel.h"

namespace fretwork {

CollapseMesh::CollapseMesh(const TriangleMesh& mesh)
    : positions_(mesh.positions_mm),
      triangles_(mesh.triangles),
      across_(3 * mesh.triangles.size(), kNone),
      corner_of_(mesh.positions_mm.size(), kNone),
      dead_(mesh.triangles.size(), 0) {
    // The corners that face an edge, filed under its lower vertex; a few each, so that partners are found by looking.
    std::vector<std::uint32_t> first(positions_.size() + 1, 0);
    for (const Triangle& t : triangles_)
        for (std::size_t k = 0; k < 3; ++k) ++first[std::min(t[k], t[k == 2 ? 0 : k + 1]) + 1];
    for (std::size_t v = 0; v < positions_.size(); ++v) first[v + 1] += first[v];
    std::vector<Corner> facing(across_.size());
    Corner c = 0;
    for (const Triangle& t : triangles_)
        for (std::size_t k = 0; k < 3; ++k, ++c) {
            corner_of_[t[k]] = c;
            // Moves the start of each vertex to its end, which is where the next one started.
            facing[first[std::min(t[k == 2 ? 0 : k + 1], t[k == 0 ? 2 : k - 1])]++] = c;
        }
    parallel_for(positions_.size(), 1 << 14, [&](std::size_t v) {
        const std::span<const Corner> filed(facing.data() + (v == 0 ? 0 : first[v - 1]), facing.data() + first[v]);
        link_partners(filed);
    });
}

/// Links corners that face an edge with the same higher vertex, in pairs, the first two of them first.
void CollapseMesh::link_partners(std::span<const Corner> filed) {
    const auto high = [&](Corner c) { return std::max(vertex(next(c)), vertex(previous(c))); };
    for (std::size_t j = 1; j < filed.size(); ++j)
        for (std::size_t i = 0; i < j && across_[filed[j]] == kNone; ++i)
            if (across_[filed[i]] == kNone && high(filed[i]) == high(filed[j])) link(filed[i], filed[j]);
}

void CollapseMesh::link(Corner a, Corner b) {
    across_[a] = b;
    across_[b] = a;
}

void CollapseMesh::corners_around(std::uint32_t v, std::vector<Corner>& corners) const {
    corners.clear();
    const Corner start = corner_of_[v];
    Corner c = start;
    do {
        corners.push_back(c);
        c = turned(c);
    } while (c != start);
}

bool CollapseMesh::degree_at_least_four(Corner c) const {
    Corner d = c;
    for (int k = 0; k < 3; ++k) {
        d = turned(d);
        if (d == c) return false;
    }
    return true;
}

bool CollapseMesh::may_collapse(const std::vector<Corner>& around_u, Corner edge) const {
    if (around_u.size() < 3) return false;
    const std::uint32_t apex_a = vertex(previous(edge));
    const Corner other = across_[previous(edge)];  // faces the edge from the other side
    const std::uint32_t apex_b = vertex(other);
    if (apex_a == apex_b) return false;
    if (!degree_at_least_four(previous(edge)) || !degree_at_least_four(other)) return false;
    // Common neighbours of u and v.
    const Corner at_v = next(edge);
    Corner c = at_v;
    do {
        const std::uint32_t w = vertex(next(c));
        if (w != apex_a && w != apex_b)
            for (const Corner d : around_u)
                if (vertex(next(d)) == w) return false;
        c = turned(c);
    } while (c != at_v);
    return true;
}

void CollapseMesh::collapse(const std::vector<Corner>& around_u, Corner edge) {
    const std::uint32_t u = vertex(edge), v = vertex(next(edge));
    const Corner other = across_[previous(edge)];
    const std::uint32_t dead_a = edge / 3, dead_b = other / 3;
    // Outer neighbours of the two dying triangles, across the sides that stay: for each, the side at u and the one at v
    // become one.
    const Corner a_at_u = across_[next(edge)], a_at_v = across_[edge];
    const Corner b_u = vertex(next(other)) == u ? next(other) : previous(other);
    const Corner b_v = vertex(next(other)) == u ? previous(other) : next(other);
    const Corner b_at_u = across_[b_v], b_at_v = across_[b_u];
    for (const Corner c : around_u)
        if (c / 3 != dead_a && c / 3 != dead_b) triangles_[c / 3][c % 3] = v;
    dead_[dead_a] = dead_[dead_b] = 1;
    link(a_at_u, a_at_v);
    link(b_at_u, b_at_v);
    corner_of_[u] = kNone;
    // A corner that faces the merged side has its ends next to it.
    for (const Corner c : {a_at_u, b_at_u})
        for (const Corner end : {next(c), previous(c)}) corner_of_[vertex(end)] = end;
}

void CollapseMesh::undo(Corner edge, std::span<const Corner> stayed) {
    const std::uint32_t u = vertex(edge);
    const Corner other = facing(edge);
    dead_[edge / 3] = dead_[other / 3] = 0;
    for (const Corner c : stayed) triangles_[c / 3][c % 3] = u;
    for (const Corner c : {edge, next(edge), next(other), previous(other)}) across_[across_[c]] = c;
    const auto stands = [&](Corner c) {
        for (const Corner at : {c, next(c), previous(c)}) corner_of_[vertex(at)] = at;
    };
    for (const Corner c : stayed) stands(c);
    stands(edge);
    stands(other);
}

std::array<std::uint32_t, 4> CollapseMesh::touched_by(Corner edge) const {
    const Corner other = facing(edge);
    const std::uint32_t u = vertex(edge);
    const Corner at_u = vertex(next(other)) == u ? next(other) : previous(other);
    return {edge / 3, other / 3, across_[edge] / 3, across_[at_u] / 3};
}

}  // namespace fretwork
