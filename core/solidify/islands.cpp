#include "core/solidify/islands.h"

#include <algorithm>
#include <numeric>

#include "core/base/parallel.h"
#include "core/solidify/lattice_pieces.h"

namespace fretwork {
namespace {

constexpr std::uint32_t kNoPiece = LatticePieces::kNone;

/// A share of the wall's nodes; a closed hollow that holds fewer is trapped.
constexpr double kTrappedShare = 0.02;

std::vector<std::uint8_t> inside_nodes(const WallField& field, const NodeValues& values) {
    std::vector<std::uint8_t> inside(values.phi.size());
    parallel_for(inside.size(), 1 << 16, [&](std::size_t i) {
        inside[i] = std::max(field.limits().slab(static_cast<double>(values.phi[i])),
                             static_cast<double>(values.pattern[i])) < 0.0
                        ? 1
                        : 0;
    });
    return inside;
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
    const LatticePieces pieces = find_pieces(lattice, inside_nodes(field, values), run);
    const std::vector<std::uint32_t>& piece = pieces.of_node;
    // (component, piece) of every inside node, counted by sorting; runs of equal ones are kept as one with its length.
    struct Run {
        std::uint64_t pair;
        std::size_t length;
    };
    std::vector<Run> runs;
    for (NodeIndex node = 0; node < piece.size(); ++node) {
        if (piece[node] == LatticePieces::kNone) continue;
        const std::uint64_t pair =
            (static_cast<std::uint64_t>(triangle_component[values.triangle[node]]) << 32) | piece[node];
        if (runs.empty() || runs.back().pair != pair) runs.push_back({pair, 0});
        ++runs.back().length;
    }
    std::sort(runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.pair < b.pair; });
    std::vector<std::uint8_t> stays(pieces.count(), 0);
    for (std::size_t i = 0; i < runs.size();) {
        const std::uint64_t component = runs[i].pair >> 32;
        std::size_t best = 0, most = 0;
        while (i < runs.size() && runs[i].pair >> 32 == component) {
            const std::uint64_t pair = runs[i].pair;
            std::size_t length = 0;
            for (; i < runs.size() && runs[i].pair == pair; ++i) length += runs[i].length;
            if (length <= most) continue;
            most = length;
            best = pair & 0xFFFFFFFFU;
        }
        stays[best] = 1;
    }
    RemovedIslands removed;
    const double cell_mm3 = lattice.step_mm() * lattice.step_mm() * lattice.step_mm();
    for (std::size_t p = 0; p < pieces.count(); ++p) {
        if (stays[p] != 0) continue;
        ++removed.count;
        removed.volume_mm3 += static_cast<double>(pieces.nodes[p]) * cell_mm3;
    }
    for (NodeIndex node = 0; node < piece.size(); ++node)
        if (piece[node] != LatticePieces::kNone && stays[piece[node]] == 0) values.pattern[node] = 1.0F;
    return removed;
}

std::size_t fill_trapped_hollows(const WallLattice& lattice, const WallField& field, NodeValues& values,
                                 const RunControl& run) {
    std::vector<std::uint8_t> wanted = inside_nodes(field, values);
    std::size_t solid = 0;
    for (std::uint8_t& w : wanted) {
        solid += w;
        w = w == 0 ? 1 : 0;
    }
    const auto most = static_cast<std::size_t>(kTrappedShare * static_cast<double>(solid));

    // The middle of the wall; an open surface has no lower limit, and its wall lies around it.
    const WallLimits& limits = field.limits();
    const float middle = limits.signed_distance ? static_cast<float>(0.5 * (limits.lower + limits.upper)) : 0.0F;
    const LatticePieces hollows = find_pieces(lattice, wanted, run);
    std::size_t filled = 0;
    std::vector<std::uint8_t> fill(hollows.count(), 0);
    for (std::size_t h = 0; h < fill.size(); ++h) {
        fill[h] = hollows.at_end[h] == 0 && hollows.nodes[h] <= most ? 1 : 0;
        filled += fill[h];
    }
    if (filled == 0) return 0;
    for (std::size_t node = 0; node < wanted.size(); ++node)
        if (wanted[node] != 0 && fill[hollows.of_node[node]] != 0) {
            values.phi[node] = middle;
            values.pattern[node] = -1.0F;
        }
    return filled;
}

}  // namespace fretwork
