#include "support/carved_shells.h"

#include <cmath>
#include <numbers>

#include "core/base/counter_random.h"

namespace fretwork::testing {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// Surface point of a voxel, in voxels from the grid's origin.
Vec3 place(const SurfaceVoxels& shell, std::size_t v) {
    return (shell.points_mm[v] - shell.grid.origin_mm) / shell.grid.voxel_mm;
}

template <class Solid>
SolidStates where(const SurfaceVoxels& shell, const Solid& solid) {
    SolidStates states(shell.size());
    for (std::size_t v = 0; v < shell.size(); ++v)
        states[v] = solid(place(shell, v)) ? SolidState::kSolid : SolidState::kEmpty;
    return states;
}

double random_unit(std::uint64_t seed, std::uint64_t item, std::uint32_t draw) {
    return unit_interval(counter_random(seed, RandomStream::kTest, 0, item, draw));
}

}  // namespace

SolidStates stripes(const SurfaceVoxels& shell, double period_voxels, const Vec3& direction) {
    const Vec3 wave = kTurn / period_voxels * direction.normalized();
    return where(shell, [&](const Vec3& p) { return std::sin(wave.dot(p)) > 0.0; });
}

SolidStates dots(const SurfaceVoxels& shell, double period_voxels, double radius_voxels) {
    return where(shell, [&](const Vec3& p) {
        const Vec3 cell = p / period_voxels;
        const Vec3 nearest = period_voxels * cell.array().round().matrix();
        return (p - nearest).norm() < radius_voxels;
    });
}

SolidStates blobs(const SurfaceVoxels& shell, double period_voxels, std::uint64_t seed) {
    constexpr std::uint64_t kWaves = 12;
    return where(shell, [&](const Vec3& p) {
        double sum = 0.0;
        for (std::uint64_t w = 0; w < kWaves; ++w) {
            const double height = 2.0 * random_unit(seed, w, 0) - 1.0;
            const double around = kTurn * random_unit(seed, w, 1);
            const double flat = std::sqrt(1.0 - height * height);
            const Vec3 direction(flat * std::cos(around), flat * std::sin(around), height);
            const double length = kTurn / (period_voxels * (0.5 + random_unit(seed, w, 2)));
            sum += std::sin(length * direction.dot(p) + kTurn * random_unit(seed, w, 3));
        }
        return sum > 0.0;
    });
}

SolidStates dust(const SurfaceVoxels& shell, double probability, std::uint64_t seed) {
    SolidStates states(shell.size());
    for (std::size_t v = 0; v < shell.size(); ++v)
        states[v] = random_unit(seed, v, 7) < probability ? SolidState::kSolid : SolidState::kEmpty;
    return states;
}

}  // namespace fretwork::testing
