#include "core/pipeline/report_view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/parallel.h"
#include "core/solidify/shell_index.h"
#include "core/solidify/simplify.h"

namespace fretwork {
namespace {

constexpr double kMostFineTriangles = 2e6;

using Corners = std::array<Vec3, 3>;

double area_mm2(const Corners& c) {
    return 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
}

/// Halves the longest edge until all are within `edge_mm`; neighbours that halve the same edge meet at its middle.
void split(const Corners& whole, double edge_mm, std::vector<Corners>& parts) {
    std::vector<Corners> open = {whole};
    while (!open.empty()) {
        const Corners c = open.back();
        open.pop_back();
        std::size_t longest = 0;
        std::array<double, 3> length{};
        for (std::size_t k = 0; k < 3; ++k) {
            length[k] = (c[(k + 1) % 3] - c[k]).norm();
            if (length[k] > length[longest]) longest = k;
        }
        if (length[longest] <= edge_mm) {
            parts.push_back(c);
            continue;
        }
        const Vec3& a = c[longest];
        const Vec3& b = c[(longest + 1) % 3];
        const Vec3& apex = c[(longest + 2) % 3];
        const Vec3 middle = 0.5 * (a + b);
        open.push_back({a, middle, apex});
        open.push_back({middle, b, apex});
    }
}

/// Edges of triangles that are half as large as the square of it, if they are well shaped.
double edge_for(const TriangleMesh& surface, double voxel_mm) {
    double area = 0.0;
    for (const Triangle& t : surface.triangles)
        area += area_mm2({surface.positions_mm[t[0]], surface.positions_mm[t[1]], surface.positions_mm[t[2]]});
    return std::max(voxel_mm, std::sqrt(6.0 * area / kMostFineTriangles));
}

std::vector<Rgb8> vertex_colors(const CarvedMesh& carved, const Rgb8& plain) {
    std::vector<Rgb8> colors(carved.mesh.positions_mm.size(), plain);
    if (carved.triangle_colors.empty()) return colors;
    std::vector<std::array<std::uint32_t, 4>> sums(colors.size(), {0, 0, 0, 0});
    for (std::size_t t = 0; t < carved.mesh.triangles.size(); ++t)
        for (const std::uint32_t v : carved.mesh.triangles[t]) {
            for (std::size_t k = 0; k < 3; ++k) sums[v][k] += carved.triangle_colors[t][k];
            ++sums[v][3];
        }
    for (std::size_t v = 0; v < colors.size(); ++v)
        for (std::size_t k = 0; k < 3 && sums[v][3] > 0; ++k)
            colors[v][k] = static_cast<std::uint8_t>((sums[v][k] + sums[v][3] / 2) / sums[v][3]);
    return colors;
}

}  // namespace

VoxelView fine_surface(const TriangleMesh& surface, const SurfaceVoxels& shell, const RunControl& run) {
    const double edge_mm = edge_for(surface, shell.grid.voxel_mm);
    const ShellIndex index(shell);
    std::vector<std::vector<Corners>> parts(surface.triangles.size());
    std::vector<std::vector<std::uint32_t>> voxels(surface.triangles.size());
    parallel_for(surface.triangles.size(), 256, [&](std::size_t t) {
        run.throw_if_stopped();
        const Triangle& triangle = surface.triangles[t];
        const Corners whole = {surface.positions_mm[triangle[0]], surface.positions_mm[triangle[1]],
                               surface.positions_mm[triangle[2]]};
        const Vec3 normal = (whole[1] - whole[0]).cross(whole[2] - whole[0]).normalized();
        split(whole, edge_mm, parts[t]);
        for (const Corners& c : parts[t])
            voxels[t].push_back(index.nearest((c[0] + c[1] + c[2]) / 3.0, normal.cast<float>()));
    });
    VoxelView view;
    for (std::size_t t = 0; t < parts.size(); ++t)
        for (std::size_t i = 0; i < parts[t].size(); ++i) {
            if (voxels[t][i] == ShellIndex::kNone) continue;
            const auto first = static_cast<std::uint32_t>(view.mesh.positions_mm.size());
            view.mesh.positions_mm.insert(view.mesh.positions_mm.end(), parts[t][i].begin(), parts[t][i].end());
            view.mesh.triangles.push_back({first, first + 1, first + 2});
            view.triangle_voxels.push_back(voxels[t][i]);
        }
    return view;
}

VoxelView solid_part(const VoxelView& view, const SolidStates& solid) {
    VoxelView part;
    part.mesh.positions_mm = view.mesh.positions_mm;
    for (std::size_t t = 0; t < view.mesh.triangles.size(); ++t) {
        if (solid[view.triangle_voxels[t]] != SolidState::kSolid) continue;
        part.mesh.triangles.push_back(view.mesh.triangles[t]);
        part.triangle_voxels.push_back(view.triangle_voxels[t]);
    }
    return part;
}

LightView light_view(const CarvedMesh& carved, double voxel_mm, std::size_t most_triangles, const Rgb8& plain,
                     const RunControl& run) {
    const std::vector<Rgb8> colors = vertex_colors(carved, plain);
    if (carved.mesh.triangles.size() <= most_triangles) return {{carved.mesh, carved.triangle_voxels}, colors};
    SimplifySettings settings;
    settings.tolerance_mm = 0.5 * voxel_mm;
    settings.target_triangles = most_triangles;
    settings.border_mm = voxel_mm;
    settings.block_mm = 24.0 * voxel_mm;
    const MeshAreas one_area{std::vector<std::uint8_t>(carved.mesh.triangles.size(), 0),
                             std::vector<std::uint8_t>(carved.mesh.positions_mm.size(), 0)};
    SimplifiedMesh light = simplify(carved.mesh, one_area, settings, run);
    LightView view;
    view.view.mesh = std::move(light.mesh);
    for (const std::uint32_t t : light.triangle) view.view.triangle_voxels.push_back(carved.triangle_voxels[t]);
    for (const std::uint32_t v : light.vertex) view.vertex_colors.push_back(colors[v]);
    return view;
}

}  // namespace fretwork
