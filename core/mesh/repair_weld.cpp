// Welding: by equal position through a hash table, on borders within a reach through a grid.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <unordered_map>

#include "core/mesh/repair_steps.h"

namespace fretwork::repair {
namespace {

constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

std::uint64_t mix(std::uint64_t h) {
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
    return h ^ (h >> 31);
}

std::uint64_t hash_of(const Vec3& p) {
    std::uint64_t h = 0;
    // Adding zero makes -0 and +0 one.
    for (int axis = 0; axis < 3; ++axis) h = mix(h ^ std::bit_cast<std::uint64_t>(p[axis] + 0.0));
    return h;
}

/// For each vertex the first one at the same position. The table is only ever asked, never listed, so its layout
/// does not show.
std::vector<std::uint32_t> first_at_position(const std::vector<Vec3>& positions, const RunControl& run) {
    const std::size_t mask = std::bit_ceil(2 * positions.size() + 1) - 1;
    std::vector<std::uint32_t> table(mask + 1, kNone), first(positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        if (v % kOften == 0) run.throw_if_stopped();
        std::size_t slot = hash_of(positions[v]) & mask;
        while (table[slot] != kNone && positions[table[slot]] != positions[v]) slot = (slot + 1) & mask;
        if (table[slot] == kNone) table[slot] = v;
        first[v] = table[slot];
    }
    return first;
}

/// Finds, among the vertices entered so far, the closest within reach.
class ReachGrid {
  public:
    ReachGrid(const std::vector<Vec3>& positions, const Vec3& origin, double reach)
        : positions_(positions), origin_(origin), reach_(reach) {}

    void enter(std::uint32_t v) { cells_[hash(cell(positions_[v]))].push_back(v); }

    [[nodiscard]] std::uint32_t closest(std::uint32_t v) const {
        const Cell at = cell(positions_[v]);
        std::uint32_t best = kNone;
        double best2 = reach_ * reach_;
        for (int i = 0; i < 27; ++i) {
            const auto found = cells_.find(hash({at[0] + i % 3 - 1, at[1] + i / 3 % 3 - 1, at[2] + i / 9 - 1}));
            if (found == cells_.end()) continue;
            for (const std::uint32_t w : found->second) {
                const double distance2 = (positions_[w] - positions_[v]).squaredNorm();
                if (distance2 < best2 || (distance2 == best2 && w < best)) best = w, best2 = distance2;
            }
        }
        return best;
    }

  private:
    using Cell = std::array<std::int64_t, 3>;
    [[nodiscard]] Cell cell(const Vec3& p) const {
        Cell c{};
        for (int axis = 0; axis < 3; ++axis)
            c[static_cast<std::size_t>(axis)] =
                static_cast<std::int64_t>(std::floor((p[axis] - origin_[axis]) / reach_));
        return c;
    }
    static std::uint64_t hash(const Cell& c) {
        std::uint64_t h = 0;
        for (const std::int64_t x : c) h = mix(h ^ static_cast<std::uint64_t>(x));
        return h;
    }

    const std::vector<Vec3>& positions_;
    Vec3 origin_;
    double reach_;
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

void weld_equal_positions(Draft& draft) {
    const std::size_t before = draft.mesh.positions_mm.size();
    std::vector<std::uint8_t> used(before, 0);
    for (const Triangle& t : draft.mesh.triangles)
        for (const std::uint32_t v : t) used[v] = 1;
    const std::vector<std::uint32_t> first = first_at_position(draft.mesh.positions_mm, draft.run);
    for (std::size_t v = 0; v < before; ++v) {
        if (used[v] == 0)
            ++draft.counts.unused_vertices;
        else if (first[v] != v)
            ++draft.counts.welded_vertices;
    }
    remap_vertices(draft, first);
}

void weld_borders(Draft& draft, double reach_mm) {
    const std::vector<Vec3>& positions = draft.mesh.positions_mm;
    std::vector<std::uint8_t> border(positions.size(), 0);
    bool any = false;
    const EdgeTable edges(draft.mesh, draft.run);
    for (std::size_t e = 0; e < edges.size(); ++e)
        if (edges.half_edges(e).size() == 1) border[edges.low(e)] = border[edges.high(e)] = 1, any = true;
    if (!any) return;
    Vec3 low = positions[0], high = positions[0];
    for (const Vec3& p : positions) low = low.cwiseMin(p), high = high.cwiseMax(p);
    if (!(reach_mm > 1e-12 * (high - low).maxCoeff())) return;  // below the rounding of the coordinates
    ReachGrid grid(positions, low, reach_mm);
    std::vector<std::uint32_t> target(positions.size());
    for (std::uint32_t v = 0; v < positions.size(); ++v) {
        if (v % kOften == 0) draft.run.throw_if_stopped();
        target[v] = v;
        if (border[v] == 0) continue;
        if (const std::uint32_t w = grid.closest(v); w != kNone) {
            target[v] = w;
            ++draft.counts.border_welds;
        } else {
            grid.enter(v);
        }
    }
    remap_vertices(draft, target);
}

void remap_vertices(Draft& draft, const std::vector<std::uint32_t>& target) {
    std::vector<std::uint8_t> used(target.size(), 0);
    for (Triangle& t : draft.mesh.triangles)
        for (std::uint32_t& v : t) {
            v = target[v];
            used[v] = 1;
        }
    std::vector<std::uint32_t> moved(target.size());
    std::uint32_t count = 0;
    for (std::uint32_t v = 0; v < target.size(); ++v)
        if (used[v] != 0) {
            moved[v] = count;
            draft.mesh.positions_mm[count++] = draft.mesh.positions_mm[v];
        }
    draft.mesh.positions_mm.resize(count);
    for (Triangle& t : draft.mesh.triangles)
        for (std::uint32_t& v : t) v = moved[v];
}

void drop_triangles(Draft& draft, const std::vector<std::uint8_t>& drop) {
    std::size_t kept = 0;
    for (std::size_t t = 0; t < drop.size(); ++t)
        if (drop[t] == 0) {
            draft.mesh.triangles[kept] = draft.mesh.triangles[t];
            draft.source[kept++] = draft.source[t];
        }
    if (kept == drop.size()) return;
    draft.mesh.triangles.resize(kept);
    draft.source.resize(kept);
    std::vector<std::uint32_t> same(draft.mesh.positions_mm.size());
    std::iota(same.begin(), same.end(), 0u);
    remap_vertices(draft, same);
}

}  // namespace fretwork::repair
