#include "core/pipeline/keep_regions.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

void turn_to(const std::vector<std::uint32_t>& source_triangles, std::size_t file_triangles, Region& region) {
    auto* set = std::get_if<TriangleSetRegion>(&region.shape);
    if (!set) return;
    std::vector<std::uint8_t> wanted(file_triangles, 0);
    for (const std::uint32_t t : set->triangles) {
        if (t >= file_triangles)
            throw InvalidSetting(
                fmt::format("region '{}' names triangle {}, and the model has {}", region.name, t, file_triangles));
        wanted[t] = 1;
    }
    set->triangles.clear();
    for (std::uint32_t t = 0; t < source_triangles.size(); ++t)
        if (wanted[source_triangles[t]]) set->triangles.push_back(t);
    if (set->triangles.empty())
        throw InvalidSetting(fmt::format("region '{}' names only triangles that repair has dropped", region.name));
}

}  // namespace

Settings with_triangles_of(const std::vector<std::uint32_t>& source_triangles, std::size_t file_triangles,
                           Settings settings) {
    const auto turn = [&](Region& region) { turn_to(source_triangles, file_triangles, region); };
    for (Region& region : settings.keep) turn(region);
    for (Region& region : settings.carve) turn(region);
    for (LoadOption& load : settings.loads) turn(load.region);
    for (FixtureOption& fixture : settings.fixtures) turn(fixture.region);
    return settings;
}

RegionField keep_regions(const TriangleMesh& mesh, const Settings& settings) {
    return RegionField(mesh, settings.keep, settings.carve);
}

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
