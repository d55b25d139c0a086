#include "core/pipeline/keep_regions.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

std::string some_names(const std::vector<NamedTriangles>& named) {
    constexpr std::size_t kMost = 12;
    if (named.empty()) return "none";
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(named.size(), kMost); ++i) names.push_back(named[i].name);
    return fmt::format("{}{}", fmt::join(names, ", "), named.size() > kMost ? ", ..." : "");
}

/// Triangles of the file that the region names; several things of one name all belong to it.
std::vector<std::uint32_t> triangles_named(const NamedRegion& region, const std::string& region_name,
                                           const FileTriangles& file) {
    std::vector<std::uint32_t> triangles;
    for (const std::string& name : region.names) {
        const std::size_t before = triangles.size();
        for (const NamedTriangles& named : file.named) {
            if (named.name != name) continue;
            for (std::uint32_t t = 0; t < named.triangle_count; ++t) triangles.push_back(named.first_triangle + t);
        }
        if (triangles.size() == before)
            throw InvalidSetting(fmt::format("region '{}' names '{}', and the model has: {}", region_name, name,
                                             some_names(file.named)));
    }
    return triangles;
}

/// Triangles of the repaired mesh that are part of those of the file.
TriangleSetRegion repaired_set(const TriangleSetRegion& of_file, const std::string& name,
                               const std::vector<std::uint32_t>& source_triangles, const FileTriangles& file) {
    std::vector<std::uint8_t> wanted(file.count, 0);
    for (const std::uint32_t t : of_file.triangles) {
        if (t >= file.count)
            throw InvalidSetting(
                fmt::format("region '{}' names triangle {}, and the model has {}", name, t, file.count));
        wanted[t] = 1;
    }
    TriangleSetRegion set;
    for (std::uint32_t t = 0; t < source_triangles.size(); ++t)
        if (wanted[source_triangles[t]]) set.triangles.push_back(t);
    if (set.triangles.empty())
        throw InvalidSetting(fmt::format("region '{}' names only triangles that repair has dropped", name));
    return set;
}

}  // namespace

Settings regions_on(const PreparedSurface& surface, const FileTriangles& file, Settings settings) {
    const auto turn = [&](Region& region) {
        if (const auto* named = std::get_if<NamedRegion>(&region.shape))
            region.shape = TriangleSetRegion{triangles_named(*named, region.name, file)};
        if (const auto* set = std::get_if<TriangleSetRegion>(&region.shape))
            region.shape = repaired_set(*set, region.name, surface.source_triangles, file);
        if (auto* volume = std::get_if<VolumeRegion>(&region.shape))
            for (Vec3& p : volume->surface.positions_mm) p = in_model_mm(p, settings.input.up, surface.scale);
    };
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
