#include "core/solidify/solidify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/closest_point.h"
#include "core/solidify/islands.h"
#include "core/solidify/lattice_shift.h"
#include "core/solidify/marching_tets.h"
#include "core/solidify/sharpen.h"
#include "core/solidify/shell_index.h"
#include "core/solidify/simplify.h"
#include "core/solidify/wall_field.h"
#include "core/solidify/wall_lattice.h"

namespace fretwork {
namespace {

constexpr const char* kStage = "solidify";

std::string plain(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

bool has_border(const TriangleMesh& mesh) {
    std::vector<std::uint64_t> edges;
    edges.reserve(3 * mesh.triangles.size());
    for (const Triangle& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint64_t a = t[k], b = t[(k + 1) % 3];
            if (a != b) edges.push_back((std::min(a, b) << 32) | std::max(a, b));
        }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size();) {
        std::size_t j = i;
        while (j < edges.size() && edges[j] == edges[i]) ++j;
        if (j - i == 1) return true;
        i = j;
    }
    return false;
}

WallLimits wall_limits(const TriangleMesh& mesh, const SurfaceVoxels& shell, const SolidifySettings& settings) {
    const double voxel = shell.grid.voxel_mm;
    const double t = settings.thickness_mm / voxel;
    if (!(settings.thickness_mm > 0.0) || !std::isfinite(settings.thickness_mm))
        throw InvalidSetting("thickness_mm = " + plain(settings.thickness_mm) + ": expected a length above 0 mm");
    if (!(settings.simplify_tolerance_voxels >= 0.0) || settings.simplify_tolerance_voxels > 1.0)
        throw InvalidSetting("simplify_tolerance_voxels = " + plain(settings.simplify_tolerance_voxels) +
                             ": expected a value in [0, 1]");
    if (t < 2.0 * (1.0 - 1e-9)) {
        const int side = *std::max_element(shell.grid.extent.begin(), shell.grid.extent.end());
        throw ConstraintsNotMet("thickness_mm = " + plain(settings.thickness_mm) + " mm is " + plain(t) +
                                " voxels of " + plain(voxel) + " mm, under two: raise the resolution to " +
                                std::to_string(static_cast<long>(std::ceil(2.0 * side / t))) + " or the thickness to " +
                                plain(2.0 * voxel) + " mm");
    }
    const bool open = has_border(mesh);
    if (open && settings.side != WallSide::kCentred)
        throw ConstraintsNotMet(
            "side: the surface is open and has no inside to grow into or out of; use the centred wall");
    switch (settings.side) {
        case WallSide::kInward:
            return {-t, 0.0, true};
        case WallSide::kOutward:
            return {0.0, t, true};
        case WallSide::kCentred:
            break;
    }
    if (open) return {-std::numeric_limits<double>::infinity(), 0.5 * t, false};
    return {-0.5 * t, 0.5 * t, true};
}

/// The least share of an edge between a vertex and a node. Rounding to float must not carry a vertex past a node.
double edge_clamp(const WallLattice& lattice, const SurfaceVoxels& shell) {
    const VoxelGrid& grid = shell.grid;
    const Vec3 far = grid.origin_mm + grid.voxel_mm * Vec3(grid.extent[0], grid.extent[1], grid.extent[2]);
    const double largest = std::max(grid.origin_mm.cwiseAbs().maxCoeff(), far.cwiseAbs().maxCoeff());
    const double spacing = largest * static_cast<double>(std::numeric_limits<float>::epsilon());
    return std::clamp(16.0 * spacing / lattice.step_mm(), 1e-3, 0.2);
}

/// Every triangle shows the pattern at its closest surface point, on outer, inner and hole faces alike.
void paint(const SurfaceVoxels& shell, const WallField& field, const PatternField& pattern, CarvedMesh& carved,
           const RunControl& run) {
    const ShellIndex index(shell);
    const std::size_t n = carved.mesh.triangles.size();
    carved.triangle_colors.resize(n);
    carved.triangle_voxels.resize(n);
    parallel_chunks(n, 1024, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        for (std::size_t i = begin; i < end; ++i) {
            const auto& [a, b, c] = carved.mesh.triangles[i];
            const std::vector<Vec3>& at = carved.mesh.positions_mm;
            const ClosestPoint closest = field.tree().closest((at[a] + at[b] + at[c]) / 3.0);
            carved.triangle_colors[i] = pattern.color(closest.point_mm, closest.triangle);
            const VoxelIndex v = index.nearest(closest.point_mm, field.triangle_normal(closest.triangle).cast<float>());
            carved.triangle_voxels[i] = v == ShellIndex::kNone ? 0 : v;
        }
    });
}

std::vector<Rgb8> vertex_colors(const WallMesh& wall, const WallField& field, const PatternField& pattern,
                                const RunControl& run) {
    std::vector<Rgb8> colors(wall.vertices.size());
    parallel_chunks(colors.size(), 4096, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        for (std::size_t v = begin; v < end; ++v) {
            const std::uint32_t triangle = wall.vertices[v].triangle;
            colors[v] = pattern.color(field.closest_on(triangle, wall.vertices[v].position_mm), triangle);
        }
    });
    return colors;
}

SimplifySettings simplify_settings(const SolidifySettings& settings, double voxel_mm) {
    SimplifySettings simplify;
    // A target without a tolerance starts from the smallest one that does anything.
    simplify.tolerance_mm = std::max(settings.simplify_tolerance_voxels, 0.01) * voxel_mm;
    simplify.target_triangles = settings.target_triangles;
    simplify.block_mm = 24.0 * voxel_mm;
    if (!settings.keep_colors) simplify.color_step = 255;
    return simplify;
}

}  // namespace

CarvedMesh solidify(const TriangleMesh& mesh, const SurfaceVoxels& shell, const PatternField& pattern,
                    const SolidifySettings& settings, const RunControl& run) {
    if (mesh.triangles.empty() || shell.size() == 0) throw InvalidInput("solidify: the surface is empty");
    const WallLimits limits = wall_limits(mesh, shell, settings);
    run.checkpoint(kStage, 0.0);

    const SurfaceTree tree(mesh);
    const WallField field(mesh, tree, pattern, shell.grid.voxel_mm, limits);
    const WallLattice lattice(shell, lattice_shift(mesh, shell.grid, limits), field.reach_voxels());
    run.checkpoint(kStage, 0.05);
    NodeValues values = sample_wall(lattice, field, run);
    run.checkpoint(kStage, 0.3);

    CarvedMesh carved;
    const RemovedIslands islands = remove_islands(lattice, field, triangle_components(mesh), values, run);
    carved.islands_removed = islands.count;
    carved.islands_volume_mm3 = islands.volume_mm3;
    carved.hollows_filled = fill_trapped_hollows(lattice, field, values, run);
    run.checkpoint(kStage, 0.35);
    const WallMesh wall = march_tetrahedra(lattice, values, field, edge_clamp(lattice, shell), run);
    run.checkpoint(kStage, 0.6);
    carved.mesh = sharpened_mesh(wall, shell.grid.voxel_mm, run);
    if (carved.mesh.triangles.empty())
        throw ConstraintsNotMet("solidify: no material is left; the pattern is empty everywhere");
    run.checkpoint(kStage, 0.7);
    if (settings.simplify_tolerance_voxels > 0.0 || settings.target_triangles > 0)
        carved.mesh = simplify(carved.mesh, vertex_colors(wall, field, pattern, run),
                               simplify_settings(settings, shell.grid.voxel_mm), run);
    run.checkpoint(kStage, 0.9);
    paint(shell, field, pattern, carved, run);
    run.checkpoint(kStage, 1.0);
    return carved;
}

}  // namespace fretwork
