#include "core/pipeline/shell_strength.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "core/base/parallel.h"
#include "core/mesh/nearest_point.h"

namespace fretwork {

ShellStrength strength_on_shell(const SurfaceVoxels& shell, const SolidStates& solid, const StrengthCheck& check,
                                const RunControl& run) {
    std::vector<VoxelIndex> places;
    std::vector<Vec3> points_mm;
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (solid[v] == SolidState::kSolid) {
            places.push_back(v);
            points_mm.push_back(shell.points_mm[v]);
        }
    const NearestPoint nearest(std::move(points_mm), run);
    std::vector<std::uint32_t> place_of(check.voxels.size());
    parallel_for(check.voxels.size(), 1 << 12, [&](std::size_t i) {
        if (i % 1024 == 0) run.throw_if_stopped();
        place_of[i] = nearest.to(check.grid.center_mm(check.voxels[i]));
    });

    constexpr float kMpaPerPa = 1e-6F;
    ShellStrength result;
    result.factor.assign(shell.size(), static_cast<float>(kMostFactor));
    result.stress_mpa.assign(shell.size(), -1.0F);
    for (std::size_t i = 0; i < check.voxels.size(); ++i) {
        const VoxelIndex v = places[place_of[i]];
        result.factor[v] = std::min(result.factor[v], check.report.worst_factor[i]);
        result.stress_mpa[v] = std::max(result.stress_mpa[v], kMpaPerPa * check.report.worst_stress_sum_pa[i]);
    }
    return result;
}

}  // namespace fretwork
