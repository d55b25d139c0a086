#include "core/pyramid/voxel_pyramid.h"

#include <array>
#include <functional>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/pyramid/coarsen.h"
#include "core/pyramid/neighborhoods.h"

namespace fretwork {
namespace {

WeightedLevel finest_level(const SurfaceVoxels& shell) {
    WeightedLevel finest;
    // The largest arrays first; what costs is the first touch of their memory.
    const std::array<std::function<void()>, 9> copies = {
        [&] { finest.level.adjacency.neighbor = shell.adjacency.neighbor; },
        [&] { finest.level.adjacency.length_voxels = shell.adjacency.length_voxels; },
        [&] { finest.level.coords = shell.coords; },
        [&] { finest.level.normals = shell.normals; },
        [&] { finest.centroids = shell.centroids_voxels; },
        [&] { finest.level.positions.resize(shell.size()); },
        [&] { finest.facing.resize(shell.size()); },
        [&] { finest.area_voxels2.resize(shell.size()); },
        [&] { finest.level.adjacency.first = shell.adjacency.first; }};
    parallel_for(copies.size(), 1, [&](std::size_t k) { copies[k](); });
    const double voxel = shell.grid.voxel_mm;
    parallel_for(shell.size(), 8192, [&](std::size_t v) {
        finest.level.positions[v] = ((shell.points_mm[v] - shell.grid.origin_mm) / voxel).cast<float>();
        const auto in_voxels = [&](float mm2) {
            return static_cast<float>(static_cast<double>(mm2) / (voxel * voxel));
        };
        finest.area_voxels2[v] = in_voxels(shell.area_mm2[v]);
        finest.facing[v] = in_voxels(shell.facing_area_mm2[v]) * shell.normals[v];
    });
    return finest;
}

}  // namespace

VoxelPyramid build_pyramid(const SurfaceVoxels& shell, int levels, const RunControl& run) {
    if (levels < 1) throw InvalidSetting("build_pyramid: levels is " + std::to_string(levels) + ", expected 1 or more");
    run.checkpoint("pyramid", 0.0);
    VoxelPyramid pyramid;
    WeightedLevel current = finest_level(shell);
    // Each level has about a quarter of the entries of the one before, so a quarter of what is left to do
    // remains after it.
    double left = 1.0;
    for (int made = 1;; ++made) {
        current.level.neighborhoods = find_neighborhoods(current.level, made - 1, run);
        left *= 0.25;
        run.checkpoint("pyramid", 1.0 - left);
        const bool single_cells = current.level.adjacency.neighbor.empty();
        if (made == levels || single_cells) break;
        WeightedLevel coarser = coarsen(current, made, run);
        pyramid.levels.push_back(std::move(current.level));
        current = std::move(coarser);
    }
    pyramid.levels.push_back(std::move(current.level));
    run.checkpoint("pyramid", 1.0);
    return pyramid;
}

}  // namespace fretwork
