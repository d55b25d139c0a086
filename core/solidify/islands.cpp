#include "core/solidify/islands.h"

#include <algorithm>
#include <numeric>

namespace fretwork {
namespace {

constexpr std::uint32_t kNoPiece = ~std::uint32_t{0};

/// A share of the wall's nodes; a closed hollow that holds fewer is trapped.
constexpr double kTrappedShare = 0.02;

bool inside(const WallField& field, const NodeValues& values, NodeIndex node) {
    return std::max(field.limits().slab(static_cast<double>(values.phi[node])),
                    static_cast<double>(values.pattern[node])) < 0.0;
}

/// Calls `visit` for the nodes that the edges of the tetrahedra join to `node`; kNone where the lattice ends.
template <class Visit>
void for_each_joined(const WallLattice& lattice, NodeIndex node, const Visit& visit) {
    const NodeCoord c = lattice.coord(node);
    for (std::int32_t m = 1; m < 8; ++m)
        for (const std::int32_t way : {-1, 1})
            visit(lattice.find({c[0] + way * (m & 1), c[1] + way * ((m >> 1) & 1), c[2] + way * (m >> 2)}));
}

/// Numbers the pieces of solid: nodes joined by lattice edges whose two ends are inside, as the tetrahedra join them.
std::vector<std::uint32_t> label_pieces(const WallLattice& lattice, const WallField& field, const NodeValues& values,
                                        std::uint32_t& pieces, const RunControl& run) {
    std::vector<std::uint32_t> piece(lattice.node_count(), kNoPiece);
    std::vector<NodeIndex> stack;
    pieces = 0;
    for (NodeIndex seed = 0; seed < lattice.node_count(); ++seed) {
        if (piece[seed] != kNoPiece || !inside(field, values, seed)) continue;
        piece[seed] = pieces;
        stack.assign(1, seed);
        run.throw_if_stopped();
        while (!stack.empty()) {
            const NodeIndex node = stack.back();
            stack.pop_back();
            for_each_joined(lattice, node, [&](NodeIndex next) {
                if (next == WallLattice::kNone || piece[next] != kNoPiece || !inside(field, values, next)) return;
                piece[next] = pieces;
                stack.push_back(next);
            });
        }
        ++pieces;
    }
    return piece;
}

}  // namespace

std::vector<std::uint32_t> triangle_components(const TriangleMesh& mesh) {
    std::vector<std::uint32_t> leader(mesh.positions_mm.size());
    std::iota(leader.begin(), leader.end(), 0U);
    const auto root = [&](std::uint32_t v) {
        while (leader[v] != v) v = leader[v] = leader[leader[v]];
        return v;
    };
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : {t[1], t[2]}) {
            const std::uint32_t a = root(t[0]), b = root(v);
            leader[std::max(a, b)] = std::min(a, b);
        }
    std::vector<std::uint32_t> number(leader.size(), kNoPiece), component(mesh.triangles.size());
    std::uint32_t count = 0;
    for (std::size_t t = 0; t < component.size(); ++t) {
        std::uint32_t& id = number[root(mesh.triangles[t][0])];
        if (id == kNoPiece) id = count++;
        component[t] = id;
    }
    return component;
}

RemovedIslands remove_islands(const WallLattice& lattice, const WallField& field,
                              const std::vector<std::uint32_t>& triangle_component, NodeValues& values,
                              const RunControl& run) {
    std::uint32_t pieces = 0;
    const std::vector<std::uint32_t> piece = label_pieces(lattice, field, values, pieces, run);
    // (component, piece) of every inside node, counted by sorting: few pieces hold nodes of two components.
    std::vector<std::uint64_t> pairs;
    std::vector<std::size_t> nodes(pieces, 0);
    for (NodeIndex node = 0; node < piece.size(); ++node) {
        if (piece[node] == kNoPiece) continue;
        ++nodes[piece[node]];
        pairs.push_back((static_cast<std::uint64_t>(triangle_component[values.triangle[node]]) << 32) | piece[node]);
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<std::uint8_t> stays(pieces, 0);
    for (std::size_t i = 0; i < pairs.size();) {
        const std::uint64_t component = pairs[i] >> 32;
        std::size_t best = 0, most = 0;
        while (i < pairs.size() && pairs[i] >> 32 == component) {
            std::size_t j = i;
            while (j < pairs.size() && pairs[j] == pairs[i]) ++j;
            if (j - i > most) {
                most = j - i;
                best = pairs[i] & 0xFFFFFFFFU;
            }
            i = j;
        }
        stays[best] = 1;
    }
    RemovedIslands removed;
    const double cell_mm3 = lattice.step_mm() * lattice.step_mm() * lattice.step_mm();
    for (std::size_t p = 0; p < pieces; ++p) {
        if (stays[p] != 0) continue;
        ++removed.count;
        removed.volume_mm3 += static_cast<double>(nodes[p]) * cell_mm3;
    }
    for (NodeIndex node = 0; node < piece.size(); ++node)
        if (piece[node] != kNoPiece && stays[piece[node]] == 0) values.pattern[node] = 1.0F;
    return removed;
}

std::size_t fill_trapped_hollows(const WallLattice& lattice, const WallField& field, NodeValues& values,
                                 const RunControl& run) {
    const std::size_t count = lattice.node_count();
    std::size_t solid = 0;
    for (NodeIndex node = 0; node < count; ++node) solid += inside(field, values, node) ? 1 : 0;
    const auto most = static_cast<std::size_t>(kTrappedShare * static_cast<double>(solid));

    // The middle of the wall; an open surface has no lower limit, and its wall lies around it.
    const WallLimits& limits = field.limits();
    const float middle = limits.signed_distance ? static_cast<float>(0.5 * (limits.lower + limits.upper)) : 0.0F;
    std::size_t filled = 0;
    std::vector<std::uint8_t> seen(count, 0);
    std::vector<NodeIndex> hollow;
    for (NodeIndex seed = 0; seed < count; ++seed) {
        if (seen[seed] != 0 || inside(field, values, seed)) continue;
        bool closed = true;
        seen[seed] = 1;
        hollow.assign(1, seed);
        run.throw_if_stopped();
        for (std::size_t i = 0; i < hollow.size(); ++i)
            for_each_joined(lattice, hollow[i], [&](NodeIndex next) {
                if (next == WallLattice::kNone) {
                    closed = false;
                } else if (seen[next] == 0 && !inside(field, values, next)) {
                    seen[next] = 1;
                    hollow.push_back(next);
                }
            });
        if (!closed || hollow.size() > most) continue;
        ++filled;
        for (const NodeIndex node : hollow) {
            values.phi[node] = middle;
            values.pattern[node] = -1.0F;
        }
    }
    return filled;
}

}  // namespace fretwork
