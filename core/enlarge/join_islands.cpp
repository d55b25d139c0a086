#include "core/enlarge/join_islands.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>
#include <queue>
#include <tuple>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr VoxelIndex kNone = ~VoxelIndex{0};

/// A step over an edge or a corner is taken only where the shell itself offers no way by faces.
constexpr float kDetour = 1000.0F;

int coordinate_steps(const SurfaceVoxels& shell, VoxelIndex a, VoxelIndex b) {
    int steps = 0;
    for (std::size_t k = 0; k < 3; ++k) steps += std::abs(shell.coords[a][k] - shell.coords[b][k]);
    return steps;
}

/// Voxels that must become solid.
using Detour = std::vector<VoxelIndex>;

/// The face neighbours of both ends of an edge contact, or the two-voxel detours of a corner contact: first the
/// ones that need the fewest new voxels, then the lowest indices. Empty when a solid detour exists or none at all.
Detour cheapest_detour(const SurfaceVoxels& shell, const VoxelMask& solid, const VoxelMask& may_change, VoxelIndex a,
                       VoxelIndex b) {
    std::tuple<int, VoxelIndex, VoxelIndex> best(3, kNone, kNone);
    const auto usable = [&](VoxelIndex v) { return solid[v] != 0 || may_change[v] != 0; };
    const bool corner = coordinate_steps(shell, a, b) == 3;
    for (const VoxelIndex c : shell.adjacency.of(a)) {
        if (!usable(c) || !share_face(shell, a, c)) continue;
        const int cost = solid[c] != 0 ? 0 : 1;
        if (!corner) {
            if (share_face(shell, c, b) && std::ranges::binary_search(shell.adjacency.of(c), b))
                best = std::min(best, {cost, c, kNone});
            continue;
        }
        for (const VoxelIndex d : shell.adjacency.of(c))
            if (usable(d) && share_face(shell, c, d) && share_face(shell, d, b) &&
                std::ranges::binary_search(shell.adjacency.of(d), b))
                best = std::min(best, {cost + (solid[d] != 0 ? 0 : 1), c, d});
    }
    Detour fillers;
    for (const VoxelIndex v : {std::get<1>(best), std::get<2>(best)})
        if (v != kNone && solid[v] == 0) fillers.push_back(v);
    return fillers;
}

/// Calls `fill` with the voxels that a hinge between `a` and a later voxel asks for, while it returns true.
/// \return whether all of them have been looked at
template <class Fill>
bool hinges_at(const SurfaceVoxels& shell, const VoxelMask& solid, const VoxelMask& may_change, VoxelIndex a,
               const Fill& fill) {
    const std::span<const VoxelIndex> around = shell.adjacency.of(a);
    for (const VoxelIndex b : around) {
        if (b < a || solid[b] == 0 || coordinate_steps(shell, a, b) < 2) continue;
        // A corner contact is no hinge where a third solid voxel holds both by faces or edges: those contacts
        // are looked at by themselves.
        const bool held = coordinate_steps(shell, a, b) == 3 && std::ranges::any_of(around, [&](VoxelIndex c) {
                              return solid[c] != 0 && c != b && coordinate_steps(shell, a, c) <= 2 &&
                                     coordinate_steps(shell, c, b) <= 2 &&
                                     std::ranges::binary_search(shell.adjacency.of(c), b);
                          });
        if (held) continue;
        const Detour detour = cheapest_detour(shell, solid, may_change, a, b);
        if (!detour.empty() && !fill(detour)) return false;
    }
    return true;
}

std::uint32_t root_of(std::vector<std::uint32_t>& leader, std::uint32_t a) {
    while (leader[a] != a) a = leader[a] = leader[leader[a]];
    return a;
}

struct Front {
    float distance;
    VoxelIndex voxel;
    bool operator>(const Front& o) const { return std::tuple(distance, voxel) > std::tuple(o.distance, o.voxel); }
};

/// Nearest piece of every voxel, with the way back to it.
struct Territory {
    std::vector<float> distance;
    std::vector<VoxelIndex> back;
    std::vector<std::uint32_t> piece;
};

float step_cost(const SurfaceVoxels& shell, VoxelIndex a, VoxelIndex b) {
    const auto length = static_cast<float>((shell.points_mm[a] - shell.points_mm[b]).norm() / shell.grid.voxel_mm);
    // Two sheets' points may coincide at a corner; a path must still cost something there.
    return length + 0.05F + (share_face(shell, a, b) ? 0.0F : kDetour);
}

Territory grow_territories(const SurfaceVoxels& shell, const FaceComponents& pieces, const VoxelMask& may_change,
                           const RunControl& run) {
    Territory t;
    t.distance.assign(shell.size(), kBeyondReach);
    t.back.assign(shell.size(), kNone);
    t.piece = pieces.of_voxel;
    std::priority_queue<Front, std::vector<Front>, std::greater<>> front;
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (t.piece[v] != FaceComponents::kOutside) {
            t.distance[v] = 0.0F;
            front.push({0.0F, v});
        }
    std::size_t steps = 0;
    while (!front.empty()) {
        if ((++steps & 0x3FFF) == 0) run.throw_if_stopped();
        const Front f = front.top();
        front.pop();
        if (f.distance > t.distance[f.voxel]) continue;
        for (const VoxelIndex u : shell.adjacency.of(f.voxel)) {
            if (may_change[u] == 0) continue;
            const float next = f.distance + step_cost(shell, f.voxel, u);
            if (next >= t.distance[u]) continue;
            t.distance[u] = next;
            t.back[u] = f.voxel;
            t.piece[u] = t.piece[f.voxel];
            front.push({next, u});
        }
    }
    return t;
}

}  // namespace

bool share_face(const SurfaceVoxels& shell, VoxelIndex a, VoxelIndex b) {
    return coordinate_steps(shell, a, b) == 1;
}

FaceComponents face_components(const SurfaceVoxels& shell, const VoxelMask& set) {
    FaceComponents result;
    result.of_voxel.assign(shell.size(), FaceComponents::kOutside);
    const double square_mm2 = shell.grid.voxel_mm * shell.grid.voxel_mm;
    std::vector<VoxelIndex> stack;
    for (VoxelIndex seed = 0; seed < shell.size(); ++seed) {
        if (set[seed] == 0 || result.of_voxel[seed] != FaceComponents::kOutside) continue;
        const auto id = static_cast<std::uint32_t>(result.count());
        double area = 0.0;
        result.of_voxel[seed] = id;
        stack.assign(1, seed);
        while (!stack.empty()) {
            const VoxelIndex v = stack.back();
            stack.pop_back();
            area += static_cast<double>(shell.area_mm2[v]) / square_mm2;
            for (const VoxelIndex u : shell.adjacency.of(v)) {
                if (set[u] == 0 || result.of_voxel[u] != FaceComponents::kOutside || !share_face(shell, v, u)) continue;
                result.of_voxel[u] = id;
                stack.push_back(u);
            }
        }
        result.area_voxels.push_back(area);
    }
    return result;
}

std::vector<VoxelIndex> hinge_fillers(const SurfaceVoxels& shell, const VoxelMask& solid, const VoxelMask& may_change,
                                      std::span<const VoxelIndex> at) {
    // What holds without fillers holds with them: only the others are looked at one after the other.
    std::vector<std::uint8_t> hinges(at.size(), 0);
    parallel_for(at.size(), 1 << 12, [&](std::size_t i) {
        hinges[i] = !hinges_at(shell, solid, may_change, at[i], [](const Detour&) { return false; });
    });
    std::vector<VoxelIndex> fillers;
    VoxelMask filled = solid;
    for (std::size_t i = 0; i < at.size(); ++i) {
        if (hinges[i] == 0) continue;
        hinges_at(shell, filled, may_change, at[i], [&](const Detour& detour) {
            for (const VoxelIndex v : detour) {
                filled[v] = 1;
                fillers.push_back(v);
            }
            return true;
        });
    }
    std::sort(fillers.begin(), fillers.end());
    return fillers;
}

IslandLinks link_islands(const SurfaceVoxels& shell, const FaceComponents& pieces, const VoxelMask& may_change,
                         const RunControl& run) {
    IslandLinks links;
    if (pieces.count() < 2) return links;
    const Territory t = grow_territories(shell, pieces, may_change, run);

    struct Border {
        float length;
        VoxelIndex a, b;
    };
    std::vector<Border> borders;
    for (VoxelIndex a = 0; a < shell.size(); ++a)
        for (const VoxelIndex b : shell.adjacency.of(a)) {
            if (b < a || t.piece[a] == t.piece[b] || t.distance[a] == kBeyondReach || t.distance[b] == kBeyondReach)
                continue;
            borders.push_back({t.distance[a] + t.distance[b] + step_cost(shell, a, b), a, b});
        }
    std::stable_sort(borders.begin(), borders.end(),
                     [](const Border& p, const Border& q) { return p.length < q.length; });

    std::vector<std::uint32_t> leader(pieces.count());
    std::iota(leader.begin(), leader.end(), 0U);
    for (const Border& border : borders) {
        const std::uint32_t p = root_of(leader, t.piece[border.a]);
        const std::uint32_t q = root_of(leader, t.piece[border.b]);
        if (p == q) continue;
        leader[std::max(p, q)] = std::min(p, q);
        ++links.joined;
        for (const VoxelIndex end : {border.a, border.b})
            for (VoxelIndex v = end; v != kNone; v = t.back[v]) links.path.push_back(v);
    }
    return links;
}

}  // namespace fretwork
