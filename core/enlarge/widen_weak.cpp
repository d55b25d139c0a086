#include "core/enlarge/widen_weak.h"

#include <algorithm>

#include "core/graph/pattern_width.h"

namespace fretwork {
namespace {

constexpr double kLeastGrowth = 1.5;
constexpr float kMostGain = 2.0F;

/// Weak solid voxels that something empty is near enough to, the weakest first.
std::vector<VoxelIndex> weak_voxels(const SolidStates& solid, const std::vector<float>& gain,
                                    const std::vector<float>& to_empty) {
    std::vector<VoxelIndex> weak;
    for (VoxelIndex v = 0; v < solid.size(); ++v)
        if (solid[v] == SolidState::kSolid && gain[v] > 1.0F && to_empty[v] != kBeyondReach) weak.push_back(v);
    std::stable_sort(weak.begin(), weak.end(), [&](VoxelIndex a, VoxelIndex b) { return gain[a] > gain[b]; });
    return weak;
}

}  // namespace

std::vector<VoxelIndex> widen_weak(const SurfaceVoxels& shell, const GeodesicLinks& links, const SolidStates& solid,
                                   const std::vector<float>& gain, const WidenSettings& settings,
                                   const RunControl& run) {
    constexpr double kWidest = 64.0;  // voxels; wider than any strand that grows in proportion
    const std::vector<float> half_width = pattern_half_width(shell.adjacency, solid, kWidest);
    VoxelMask empty(shell.size());
    for (std::size_t v = 0; v < empty.size(); ++v) empty[v] = solid[v] == SolidState::kSolid ? 0 : 1;
    const std::vector<float> to_empty = geodesic_distance(links, empty, settings.most_voxels, run);

    GeodesicDisc disc(links);
    std::vector<VoxelIndex> added;
    for (const VoxelIndex v : weak_voxels(solid, gain, to_empty)) {
        run.throw_if_stopped();
        const double wider = static_cast<double>(half_width[v] * (std::min(gain[v], kMostGain) - 1.0F));
        const double growth = std::clamp(wider, kLeastGrowth, settings.most_voxels);
        disc.visit(v, static_cast<double>(to_empty[v]) - 0.5 + growth, [&](VoxelIndex u, float) {
            if (empty[u] == 0 || added.size() >= settings.budget) return;
            empty[u] = 0;
            added.push_back(u);
        });
        if (added.size() >= settings.budget) break;
    }
    std::sort(added.begin(), added.end());
    return added;
}

}  // namespace fretwork
