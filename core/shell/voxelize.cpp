#include "core/shell/voxelize.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include "core/base/error.h"
#include "core/shell/cell_rows.h"
#include "core/shell/cut_mesh.h"
#include "core/shell/links.h"
#include "core/shell/shell_entries.h"

namespace fretwork {
namespace {

constexpr int kMinResolution = 4;
constexpr int kMaxResolution = 2048;
constexpr int kMostHalvings = 10;
// Between these, areas of voxels are ordinary numbers in single precision.
constexpr double kMinExtentMm = 1e-9;
constexpr double kMaxExtentMm = 1e15;

std::string as_text(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

void check_settings(const VoxelizeSettings& settings) {
    if (settings.resolution < kMinResolution || settings.resolution > kMaxResolution)
        throw InvalidSetting("voxelize: resolution is " + std::to_string(settings.resolution) + ", expected " +
                             std::to_string(kMinResolution) + " to " + std::to_string(kMaxResolution));
    if (settings.halvings < 0 || settings.halvings > kMostHalvings)
        throw InvalidSetting("voxelize: halvings is " + std::to_string(settings.halvings) + ", expected 0 to " +
                             std::to_string(kMostHalvings));
}

void check_mesh(const TriangleMesh& mesh) {
    if (mesh.triangles.empty()) throw InvalidInput("voxelize: the mesh has no triangle, expected at least one");
    for (std::size_t p = 0; p < mesh.positions_mm.size(); ++p)
        if (!mesh.positions_mm[p].allFinite())
            throw InvalidInput("voxelize: vertex " + std::to_string(p) + " has a coordinate that is not finite");
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        for (const std::uint32_t corner : mesh.triangles[t])
            if (corner >= mesh.positions_mm.size())
                throw InvalidInput("voxelize: triangle " + std::to_string(t) + " names vertex " +
                                   std::to_string(corner) + ", expected below " +
                                   std::to_string(mesh.positions_mm.size()));
}

// `resolution` voxels along the longest side. Along every axis the box lies centred in one voxel more than
// it measures, rounded: between a quarter and three quarters of a voxel stay free at each end, so that the
// outer flat faces of a model run through the middle of a layer and not along the border of two.
VoxelGrid make_grid(const TriangleMesh& mesh, const VoxelizeSettings& settings) {
    Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity());
    Vec3 high = -low;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t corner : t) {
            low = low.cwiseMin(mesh.positions_mm[corner]);
            high = high.cwiseMax(mesh.positions_mm[corner]);
        }
    const Vec3 size = high - low;
    VoxelGrid grid;
    grid.voxel_mm = size.maxCoeff() / settings.resolution;
    if (!(size.maxCoeff() >= kMinExtentMm && size.maxCoeff() <= kMaxExtentMm))
        throw InvalidInput("voxelize: the longest side of the mesh measures " + as_text(size.maxCoeff()) +
                           " mm, expected " + as_text(kMinExtentMm) + " to " + as_text(kMaxExtentMm));
    for (int k = 0; k < 3; ++k) {
        const int cells = static_cast<int>(std::lround(size[k] / grid.voxel_mm)) + 1;
        grid.extent[static_cast<std::size_t>(k)] = cells;
        grid.origin_mm[k] = 0.5 * (low[k] + high[k]) - 0.5 * cells * grid.voxel_mm;
    }
    for (std::int32_t& cells : grid.extent) cells = ((cells - 1) >> settings.halvings) + 1;
    grid.voxel_mm = std::ldexp(grid.voxel_mm, settings.halvings);
    return grid;
}

}  // namespace

SurfaceVoxels voxelize(const TriangleMesh& mesh, const VoxelizeSettings& settings, const RunControl& run) {
    check_settings(settings);
    check_mesh(mesh);
    run.checkpoint("voxelize", 0.0);

    SurfaceVoxels shell;
    shell.grid = make_grid(mesh, settings);
    const GriddedMesh gridded = lay_into_grid(mesh, shell.grid);
    run.checkpoint("voxelize", 0.05);
    LayeredPatches patches = cut_mesh(gridded, shell.grid.extent, run);
    run.checkpoint("voxelize", 0.4);
    const EntryTriangles triangles = make_entries(gridded, patches, shell, run);
    patches = {};
    run.checkpoint("voxelize", 0.7);
    const CellRows rows(shell.grid.extent, shell.coords);
    const TouchingEntries touching(rows, run);
    const TouchingLinks direct = link_shared_triangles(touching, triangles, run);
    fill_missing_normals(touching, direct, shell.normals);
    run.checkpoint("voxelize", 0.85);
    shell.adjacency = link_around_common_neighbors(touching, shell.normals, direct, run);
    shell.components = components_by_lowest_triangle(shell.adjacency, triangles);
    run.checkpoint("voxelize", 1.0);
    return shell;
}

}  // namespace fretwork
