#include "core/pipeline/shell_strength.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "core/base/parallel.h"
#include "core/mesh/nearest_point.h"

namespace fretwork {
namespace {

constexpr float kMpaPerPa = 1e-6F;

}  // namespace

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

std::vector<double> stress_on_triangles(const TriangleMesh& carved, const StrengthCheck& check, const RunControl& run) {
    std::vector<Vec3> centers_mm;
    centers_mm.reserve(check.voxels.size());
    for (const VoxelCoord& voxel : check.voxels) centers_mm.push_back(check.grid.center_mm(voxel));
    const NearestPoint nearest(std::move(centers_mm), run);
    std::vector<double> stress_mpa(carved.triangles.size());
    parallel_for(stress_mpa.size(), 1 << 12, [&](std::size_t t) {
        if (t % 1024 == 0) run.throw_if_stopped();
        const Triangle& corners = carved.triangles[t];
        const auto& p = carved.positions_mm;
        const std::uint32_t voxel = nearest.to((p[corners[0]] + p[corners[1]] + p[corners[2]]) / 3.0);
        stress_mpa[t] = double{kMpaPerPa * check.report.worst_stress_sum_pa[voxel]};
    });
    return stress_mpa;
}

}  // namespace fretwork
