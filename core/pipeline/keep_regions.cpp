#include "core/pipeline/keep_regions.h"

#include "core/base/parallel.h"

namespace fretwork {

std::vector<std::uint8_t> voxels_inside(const SurfaceVoxels& shell, const RegionField& field, const RunControl& run) {
    std::vector<std::uint8_t> inside(shell.size(), 0);
    if (field.empty()) return inside;
    parallel_chunks(shell.size(), 1024, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        for (std::size_t v = begin; v < end; ++v)
            inside[v] = field.signed_distance_mm(shell.points_mm[v], shell.triangles[v]) < 0.0 ? 1 : 0;
    });
    return inside;
}

std::vector<VoxelIndex> voxel_list_inside(const SurfaceVoxels& shell, const RegionField& field, const RunControl& run) {
    const std::vector<std::uint8_t> inside = voxels_inside(shell, field, run);
    std::vector<VoxelIndex> list;
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (inside[v]) list.push_back(v);
    return list;
}

}  // namespace fretwork
