// Sets of voxels with known or awkward shapes.
#pragma once

#include <array>
#include <cmath>
#include <functional>

#include "core/base/counter_random.h"
#include "core/strength/strength.h"

namespace fretwork::testing {

/// Voxels of a grid at the origin where `solid` says so.
inline VoxelModel voxels_where(const VoxelCoord& extent, double voxel_mm,
                               const std::function<bool(const VoxelCoord&)>& solid) {
    std::vector<VoxelCoord> cells;
    for (std::int32_t z = 0; z < extent[2]; ++z)
        for (std::int32_t y = 0; y < extent[1]; ++y)
            for (std::int32_t x = 0; x < extent[0]; ++x)
                if (solid({x, y, z})) cells.push_back({x, y, z});
    return make_voxel_model({Vec3::Zero(), voxel_mm, extent}, cells);
}

inline VoxelModel full_block(const VoxelCoord& extent, double voxel_mm = 1.0) {
    return voxels_where(extent, voxel_mm, [](const VoxelCoord&) { return true; });
}

/// A hollow ball of `side` voxels and a wall of 3.5, cut to strands by a gyroid band: like a carved object, with thin
/// strands and strands that run past each other.
inline VoxelModel carved_ball(int side, double voxel_mm = 1.0) {
    const double middle = 0.5 * side, radius = middle - 2.5;
    return voxels_where({side, side, side}, voxel_mm, [=](const VoxelCoord& c) {
        const Vec3 p(c[0] + 0.5 - middle, c[1] + 0.5 - middle, c[2] + 0.5 - middle);
        const Vec3 q = p * (2.0 * 3.14159265358979 * 4.0 / side);
        const double gyroid =
            std::sin(q[0]) * std::cos(q[1]) + std::sin(q[1]) * std::cos(q[2]) + std::sin(q[2]) * std::cos(q[0]);
        return std::abs(p.norm() - radius) <= 1.75 && std::abs(gyroid) < 0.75;
    });
}

/// About half of the voxels of a cube, at random: every kind of contact.
inline VoxelModel crumbs(int side, std::uint64_t seed, double voxel_mm = 1.0) {
    return voxels_where({side, side, side}, voxel_mm, [=](const VoxelCoord& c) {
        const auto item = static_cast<std::uint64_t>((c[2] * side + c[1]) * side + c[0]);
        return unit_interval(counter_random(seed, RandomStream::kTest, 0, item, 0)) < 0.5;
    });
}

inline Material rubbery(double youngs_modulus_mpa, double poissons_ratio) {
    return {"test", youngs_modulus_mpa, poissons_ratio, 1000.0, 30.0, 20.0};
}

inline StrengthSettings settings_with(const Material& material) {
    StrengthSettings settings;
    settings.material = material;
    settings.keep_fields = true;
    return settings;
}

/// One byte per voxel.
inline std::vector<std::uint8_t> held_where(const VoxelModel& model,
                                            const std::function<bool(const VoxelCoord&)>& is_held) {
    std::vector<std::uint8_t> held;
    for (const VoxelCoord& v : model.voxels) held.push_back(is_held(v) ? 1 : 0);
    return held;
}

}  // namespace fretwork::testing
