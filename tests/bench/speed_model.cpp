#include "speed_model.h"

#include <algorithm>
#include <cmath>

#include "support/make_meshes.h"

namespace fretwork::bench {
namespace {

constexpr double kRadiusMm = 60.0;

/// Bumps, so that coordinates use all their digits.
Vec3 uneven(const Vec3& p) {
    return p * (1.0 + 1e-3 * std::sin(1.7 * p[0]) * std::sin(2.3 * p[1]) * std::sin(1.9 * p[2]) +
                1e-5 * std::sin(97 * p[0]));
}

/// Triangles near each other in no order of rows, as remeshing leaves them; each begins at any of its corners.
void mix(std::vector<Triangle>& triangles) {
    constexpr std::size_t window = 64;
    const std::vector<Triangle> old = triangles;
    for (std::size_t t = 0; t < old.size() / window * window; ++t) {
        Triangle& moved = triangles[t / window * window + (t * 37 + t / window) % window];
        moved = old[t];
        std::ranges::rotate(moved, moved.begin() + static_cast<std::ptrdiff_t>(t * 5 % 7 % 3));
    }
}

/// One of sixteen tones per channel, the same within blocks of 2 mm.
Rgb8 color_at(const Vec3& p) {
    Rgb8 color{};
    for (int k = 0; k < 3; ++k) {
        const auto block = static_cast<int>(std::floor(p[k] / 2.0));
        color[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>((block * 7 & 15) * 17);
    }
    return color;
}

/// Up to 3 MPa, different from voxel to voxel.
float stress_at(const Vec3& p) {
    return static_cast<float>(1.5 + std::sin(0.11 * p[0]) * std::cos(0.13 * p[1]) + 0.5 * std::sin(0.07 * p[2]));
}

}  // namespace

SpeedModel make_speed_model(int side) {
    SpeedModel model;
    model.mesh = testing::make_sphere(kRadiusMm, side + 1, side);
    for (Vec3& p : model.mesh.positions_mm) p = uneven(p);
    mix(model.mesh.triangles);
    model.colors.reserve(model.mesh.triangles.size());
    for (const Triangle& t : model.mesh.triangles) model.colors.push_back(color_at(model.mesh.positions_mm[t[0]]));
    return model;
}

void add_voxels(SpeedModel& model, int cells) {
    VoxelGrid& grid = model.shell.grid;
    grid.extent = {cells, cells, cells};
    // A voxel of room on all sides.
    grid.voxel_mm = 2.0 * kRadiusMm / (cells - 2);
    grid.origin_mm = Vec3::Constant(-0.5 * grid.voxel_mm * cells);
    for (int z = 0; z < cells; ++z)
        for (int y = 0; y < cells; ++y)
            for (int x = 0; x < cells; ++x) {
                const Vec3 center = grid.center_mm({x, y, z});
                if (std::abs(center.norm() - kRadiusMm) > 0.6 * grid.voxel_mm) continue;
                model.shell.coords.push_back({x, y, z});
                const bool solid = (x / 8 + y / 8 + z / 8) % 2 == 0;
                model.solid.push_back(solid ? SolidState::kSolid : SolidState::kEmpty);
                model.reinforced.push_back(solid && x % 32 == 0 ? 1 : 0);
                model.voxel_colors.push_back(color_at(center));
                model.stress_mpa.push_back(solid ? stress_at(center) : -1.0F);
                model.labels.push_back(static_cast<std::uint16_t>(1 + (x / 12 * 31 + y / 12) * 31 + z / 12));
            }
}

}  // namespace fretwork::bench
