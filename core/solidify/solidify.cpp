#include "core/solidify/solidify.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/closest_point.h"
#include "core/solidify/color_areas.h"
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

/// How far simplifying may move a border between colours at a time, in voxels.
constexpr double kBorderSlack = 0.15;

std::string plain(double value) {
    std::string text = std::to_string(value);
    text.erase(text.find_last_not_of('0') + 1);
    if (text.back() == '.') text.pop_back();
    return text;
}

/// An edge that one triangle uses alone.
bool has_border(const TriangleMesh& mesh) {
    // The higher ends of the edges at each lower end; a few each.
    std::vector<std::uint32_t> end(mesh.positions_mm.size() + 1, 0);
    const auto for_each_edge = [&](const auto& visit) {
        for (const Triangle& t : mesh.triangles)
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t a = t[k], b = t[k == 2 ? 0 : k + 1];
                if (a != b) visit(std::min(a, b), std::max(a, b));
            }
    };
    for_each_edge([&](std::uint32_t low, std::uint32_t) { ++end[low + 1]; });
    for (std::size_t v = 0; v + 1 < end.size(); ++v) end[v + 1] += end[v];
    std::vector<std::uint32_t> high(end.back());
    for_each_edge([&](std::uint32_t low, std::uint32_t up) { high[end[low]++] = up; });
    for (std::size_t v = 0, begin = 0; v + 1 < end.size(); begin = end[v++]) {
        const std::span<std::uint32_t> ends(high.data() + begin, high.data() + end[v]);
        std::sort(ends.begin(), ends.end());
        for (std::size_t i = 0; i < ends.size(); ++i)
            if ((i == 0 || ends[i - 1] != ends[i]) && (i + 1 == ends.size() || ends[i + 1] != ends[i])) return true;
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

/// Where the vertices of the wall's mesh have their pattern from: the surface point each was found for. Two sheets that
/// nearly touch keep their patterns apart that way.
struct Anchors {
    const WallMesh& wall;
    const WallField& field;
    const PatternField& pattern;

    [[nodiscard]] std::uint32_t triangle(std::uint32_t vertex) const { return wall.vertices[vertex].triangle; }
    [[nodiscard]] Vec3 point(std::uint32_t vertex) const {
        return field.closest_on(triangle(vertex), wall.vertices[vertex].position_mm);
    }
    [[nodiscard]] Rgb8 color(std::uint32_t vertex) const { return pattern.color(point(vertex), triangle(vertex)); }
    [[nodiscard]] Rgb8 color_between(std::uint32_t a, std::uint32_t b, double share) const {
        const Vec3 from = point(a), to = point(b);
        return pattern.color(from + share * (to - from), triangle(share < 0.5 ? a : b));
    }
};

/// The surface voxel whose pattern each triangle shows: by its closest surface point, on the sheet that its first
/// corner belongs to.
std::vector<std::uint32_t> voxels_shown(const SurfaceVoxels& shell, const Anchors& anchors,
                                        const std::vector<std::uint32_t>& wall_vertex, const TriangleMesh& mesh,
                                        const RunControl& run) {
    const ShellIndex index(shell);
    const WallField& field = anchors.field;
    std::vector<std::uint32_t> voxels(mesh.triangles.size());
    parallel_chunks(voxels.size(), 1024, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        for (std::size_t i = begin; i < end; ++i) {
            const auto& [a, b, c] = mesh.triangles[i];
            const Vec3 middle = (mesh.positions_mm[a] + mesh.positions_mm[b] + mesh.positions_mm[c]) / 3.0;
            const std::uint32_t anchor = anchors.triangle(wall_vertex[a]);
            ClosestPoint closest = field.tree().closest(middle, std::numeric_limits<double>::infinity(), anchor);
            if (field.triangle_normal(closest.triangle).dot(field.triangle_normal(anchor)) < 0.0)
                closest = {field.closest_on(anchor, middle), 0.0, anchor};
            const VoxelIndex v = index.nearest(closest.point_mm, field.triangle_normal(closest.triangle).cast<float>());
            voxels[i] = v == ShellIndex::kNone ? 0 : v;
        }
    });
    return voxels;
}

/// The wall's mesh cut along the borders between the pattern's colours; uncut and without a palette if colours are not
/// asked for.
ColorAreas color_areas(const TriangleMesh& mesh, const Anchors& anchors, bool keep_colors, const RunControl& run) {
    if (!keep_colors)
        return {mesh,
                {},
                {std::vector<std::uint8_t>(mesh.triangles.size(), 0),
                 std::vector<std::uint8_t>(mesh.positions_mm.size(), 0)},
                {}};
    std::vector<Rgb8> colors(mesh.positions_mm.size());
    parallel_chunks(colors.size(), 4096, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        for (std::size_t v = begin; v < end; ++v) colors[v] = anchors.color(static_cast<std::uint32_t>(v));
    });
    return cut_into_areas(
        mesh, colors,
        [&](std::uint32_t a, std::uint32_t b, double share) { return anchors.color_between(a, b, share); }, run);
}

SimplifySettings simplify_settings(const SolidifySettings& settings, double voxel_mm) {
    SimplifySettings simplify;
    // A target without a tolerance starts from the smallest one that does anything.
    simplify.tolerance_mm = std::max(settings.simplify_tolerance_voxels, 0.01) * voxel_mm;
    simplify.target_triangles = settings.target_triangles;
    simplify.block_mm = 24.0 * voxel_mm;
    simplify.border_mm = kBorderSlack * voxel_mm;
    return simplify;
}

/// From the lattice's mesh to what is delivered: colours, fewer triangles.
void finish(const SurfaceVoxels& shell, const Anchors& anchors, const SolidifySettings& settings, const RunControl& run,
            CarvedMesh& carved) {
    const bool simplifies = settings.simplify_tolerance_voxels > 0.0 || settings.target_triangles > 0;
    const std::size_t own = carved.mesh.positions_mm.size();
    const SimplifySettings simplify_as = simplify_settings(settings, shell.grid.voxel_mm);
    ColorAreas colored = color_areas(carved.mesh, anchors, settings.keep_colors && simplifies, run);
    run.checkpoint(kStage, 0.75);
    SimplifiedMesh simple;
    if (simplifies) simple = simplify(colored.mesh, colored.areas, simplify_as, run);
    if (!simple.sound) {
        // Rounding the vertices on the borders made triangles meet.
        colored = color_areas(carved.mesh, anchors, false, run);
        simple = simplify(colored.mesh, colored.areas, simplify_as, run);
    }
    run.checkpoint(kStage, 0.9);
    std::vector<std::uint32_t> wall_vertex = std::move(simple.vertex);
    if (simplifies) {
        carved.mesh = std::move(simple.mesh);
    } else {
        wall_vertex.resize(own);
        std::iota(wall_vertex.begin(), wall_vertex.end(), 0U);
    }
    for (std::uint32_t& v : wall_vertex)
        if (v >= own) v = colored.parent[v - own];
    carved.triangle_colors.resize(carved.mesh.triangles.size());
    parallel_for(carved.mesh.triangles.size(), 1024, [&](std::size_t t) {
        carved.triangle_colors[t] = colored.palette.empty()
                                        ? anchors.color(wall_vertex[carved.mesh.triangles[t][0]])
                                        : colored.palette[colored.areas.of_triangle[simple.triangle[t]]];
    });
    carved.triangle_voxels = voxels_shown(shell, anchors, wall_vertex, carved.mesh, run);
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
    finish(shell, {wall, field, pattern}, settings, run, carved);
    run.checkpoint(kStage, 1.0);
    return carved;
}

}  // namespace fretwork
