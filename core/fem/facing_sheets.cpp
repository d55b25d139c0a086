#include "core/fem/facing_sheets.h"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include "core/base/parallel.h"
#include "core/graph/shortest_path_forest.h"

namespace fretwork {
namespace {

constexpr float kFacesAway = -0.3F;
constexpr double kLeastVoxels = 4.0;

/// Sheets of one cell, as a range of voxels.
std::pair<VoxelIndex, VoxelIndex> voxels_in(const SurfaceVoxels& shell, const VoxelCoord& cell) {
    const auto by_zyx = [](const VoxelCoord& x, const VoxelCoord& y) {
        return std::tie(x[2], x[1], x[0]) < std::tie(y[2], y[1], y[0]);
    };
    const auto [low, high] = std::equal_range(shell.coords.begin(), shell.coords.end(), cell, by_zyx);
    return {static_cast<VoxelIndex>(low - shell.coords.begin()), static_cast<VoxelIndex>(high - shell.coords.begin())};
}

}  // namespace

VoxelIndex facing_voxel(const SurfaceVoxels& shell, VoxelIndex v, double reach_mm) {
    const Vec3 inward = -shell.normals[v].cast<double>();
    const double voxel_mm = shell.grid.voxel_mm;
    for (double way = 0.0; way <= reach_mm; way += voxel_mm) {
        const Vec3 at = (shell.points_mm[v] + way * inward - shell.grid.origin_mm) / voxel_mm;
        VoxelCoord cell{};
        for (int axis = 0; axis < 3; ++axis)
            cell[static_cast<std::size_t>(axis)] = static_cast<std::int32_t>(std::floor(at[axis]));
        const auto [first, last] = voxels_in(shell, cell);
        for (VoxelIndex w = first; w < last; ++w)
            if (shell.normals[v].dot(shell.normals[w]) < kFacesAway) return w;
    }
    return kNoVoxel;
}

std::vector<VoxelIndex> facing_voxels(const SurfaceVoxels& shell, double depth_mm) {
    std::vector<VoxelIndex> result(shell.size(), kNoVoxel);
    if (depth_mm <= 0.0) return result;
    parallel_for(shell.size(), 1024,
                 [&](std::size_t v) { result[v] = facing_voxel(shell, static_cast<VoxelIndex>(v), 2.0 * depth_mm); });
    return result;
}

std::vector<SheetTie> sheet_ties(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                                 const std::vector<VoxelIndex>& facing) {
    std::vector<SheetTie> meetings;
    for (VoxelIndex v = 0; v < facing.size(); ++v) {
        const VoxelIndex w = facing[v];
        if (w == kNoVoxel || solid[v] != SolidState::kSolid || solid[w] != SolidState::kSolid) continue;
        const auto [a, b] = std::minmax(graph.owner[v], graph.owner[w]);
        // Each place is met from either side.
        if (a != b && b != kNoSample) meetings.push_back({a, b, 0.5 * static_cast<double>(shell.area_mm2[v])});
    }
    std::ranges::stable_sort(
        meetings, [](const SheetTie& x, const SheetTie& y) { return std::tie(x.a, x.b) < std::tie(y.a, y.b); });
    std::vector<SheetTie> ties;
    for (const SheetTie& meeting : meetings) {
        if (ties.empty() || ties.back().a != meeting.a || ties.back().b != meeting.b)
            ties.push_back(meeting);
        else
            ties.back().area_mm2 += meeting.area_mm2;
    }
    const double least_mm2 = kLeastVoxels * shell.grid.voxel_mm * shell.grid.voxel_mm;
    std::erase_if(ties, [&](const SheetTie& tie) { return tie.area_mm2 < least_mm2; });
    return ties;
}

}  // namespace fretwork
