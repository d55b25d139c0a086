#include "core/fem/supports.h"

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>

#include "core/shell/components.h"

namespace fretwork {
namespace {

constexpr double kLeastShare = 0.05;  // of the largest patch

struct Patch {
    std::vector<VoxelIndex> voxels;
    Vec3 middle_mm = Vec3::Zero();
};

std::vector<Patch> patches_of(const SurfaceVoxels& shell, const std::vector<VoxelIndex>& fixed) {
    SolidStates holds(shell.size(), SolidState::kEmpty);
    for (const VoxelIndex v : fixed) holds[v] = SolidState::kSolid;
    const ShellComponents parts = connected_components(shell.adjacency, holds, SolidState::kSolid);
    std::vector<Patch> patches(parts.count());
    for (const VoxelIndex v : fixed) {
        Patch& patch = patches[parts.of[v]];
        patch.voxels.push_back(v);
        patch.middle_mm += shell.points_mm[v];
    }
    for (Patch& patch : patches) patch.middle_mm /= static_cast<double>(patch.voxels.size());
    return patches;
}

/// What is held where all supports but one hold.
std::vector<VoxelIndex> all_but(const std::vector<Support>& supports, std::size_t taken) {
    std::vector<VoxelIndex> held;
    for (std::size_t s = 0; s < supports.size(); ++s) {
        if (s == taken) continue;
        std::vector<VoxelIndex> merged;
        std::ranges::set_union(held, supports[s].voxels, std::back_inserter(merged));
        held = std::move(merged);
    }
    return held;
}

bool holds_every_component(const SurfaceVoxels& shell, const std::vector<VoxelIndex>& held,
                           const std::vector<VoxelIndex>& taken) {
    std::set<std::uint32_t> still_held;
    for (const VoxelIndex v : held) still_held.insert(shell.components[v]);
    return std::ranges::all_of(taken, [&](VoxelIndex v) { return still_held.contains(shell.components[v]); });
}

}  // namespace

std::vector<Support> support_clusters(const SurfaceVoxels& shell, const std::vector<VoxelIndex>& fixed) {
    const std::vector<Patch> patches = patches_of(shell, fixed);
    std::size_t largest = 0;
    for (const Patch& patch : patches) largest = std::max(largest, patch.voxels.size());
    std::vector<Support> supports;
    std::vector<Vec3> middles_mm;
    const auto counts = [&](const Patch& patch) {
        return static_cast<double>(patch.voxels.size()) >= kLeastShare * static_cast<double>(largest);
    };
    for (const Patch& patch : patches)
        if (counts(patch)) {
            supports.push_back({"foot at " + place_name(patch.middle_mm), patch.voxels});
            middles_mm.push_back(patch.middle_mm);
        }
    for (const Patch& patch : patches) {
        if (counts(patch)) continue;
        const auto nearest = std::ranges::min_element(
            middles_mm, {}, [&](const Vec3& middle_mm) { return (middle_mm - patch.middle_mm).squaredNorm(); });
        std::vector<VoxelIndex>& voxels = supports[static_cast<std::size_t>(nearest - middles_mm.begin())].voxels;
        voxels.insert(voxels.end(), patch.voxels.begin(), patch.voxels.end());
    }
    for (Support& support : supports) std::ranges::sort(support.voxels);
    return supports;
}

std::vector<LoadCase> cases_without_a_support(const SurfaceVoxels& shell, const LoadCase& load_case,
                                              const std::vector<Support>& supports) {
    std::vector<LoadCase> cases;
    for (std::size_t s = 0; s < supports.size(); ++s) {
        std::vector<VoxelIndex> held = all_but(supports, s);
        if (!holds_every_component(shell, held, supports[s].voxels)) continue;
        LoadCase& without = cases.emplace_back(load_case);
        without.name += ", without " + supports[s].name;
        without.fixed = std::move(held);
    }
    return cases;
}

}  // namespace fretwork
