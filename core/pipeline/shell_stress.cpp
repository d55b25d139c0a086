#include "core/pipeline/shell_stress.h"

#include <algorithm>
#include <numeric>

#include "core/base/nearest_rank.h"

namespace fretwork {
namespace {

constexpr double kMegapascal = 1e6;

}  // namespace

StressFigures stress_figures(const std::vector<double>& samples_mpa) {
    if (samples_mpa.empty()) return {};
    const double sum = std::accumulate(samples_mpa.begin(), samples_mpa.end(), 0.0);
    const std::size_t count = samples_mpa.size();
    return {sum / static_cast<double>(count), samples_mpa[nearest_rank(count, 0.5)],
            samples_mpa[nearest_rank(count, 0.99)], samples_mpa.back()};
}

StressField stress_on_voxels(const SurfaceVoxels& shell, const SolidStates& solid, const ScoredPaths& scored) {
    StressField field;
    field.voxel_mpa.assign(shell.size(), -1.0F);
    std::vector<VoxelIndex> front;
    for (std::size_t e = 0; e < scored.scores_pa.size(); ++e) {
        field.samples_mpa.push_back(scored.scores_pa[e] / kMegapascal);
        for (std::uint32_t i = scored.first[e]; i < scored.first[e + 1]; ++i) {
            float& value = field.voxel_mpa[scored.voxels[i]];
            if (value < 0.0F) front.push_back(scored.voxels[i]);
            value = std::max(value, static_cast<float>(field.samples_mpa.back()));
        }
    }
    std::ranges::sort(field.samples_mpa);
    // Breadth first; of several neighbours that are as near, the one that comes first in the shell gives its value.
    std::ranges::sort(front);
    while (!front.empty()) {
        std::vector<VoxelIndex> next;
        for (const VoxelIndex v : front)
            for (const VoxelIndex n : shell.adjacency.of(v)) {
                if (field.voxel_mpa[n] >= 0.0F || solid[n] != SolidState::kSolid) continue;
                field.voxel_mpa[n] = field.voxel_mpa[v];
                next.push_back(n);
            }
        std::ranges::sort(next);
        front = std::move(next);
    }
    return field;
}

ShellStress design_stress(const SurfaceVoxels& shell, const SolidStates& first_solid, const StructureLoopResult& loop) {
    ShellStress stress;
    stress.name = "finite elements of the design model";
    stress.sample_name = "strands";
    stress.before_name = "the first pattern, with its pieces joined and nothing more";
    stress.after_name = "the reinforced one";
    stress.before = stress_on_voxels(shell, first_solid, loop.first_scored);
    stress.after = stress_on_voxels(shell, loop.solid, loop.last_scored);
    stress.allowable_mpa = loop.records.back().allowable_pa / kMegapascal;
    return stress;
}

}  // namespace fretwork
