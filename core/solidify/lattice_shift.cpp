#include "core/solidify/lattice_shift.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace fretwork {
namespace {

constexpr int kBins = 64;
constexpr double kSquare = 0.9999;  ///< cosine; steeper faces cross the node planes anyway

using Histogram = std::array<double, kBins>;

void add_plane(Histogram& area_at, double position_voxels, double area) {
    const double share = position_voxels - std::floor(position_voxels);
    area_at[static_cast<std::size_t>(static_cast<int>(share * kBins) % kBins)] += area;
}

/// The bin whose surroundings hold the least area; the nearest planes weigh most.
int emptiest(const Histogram& area_at) {
    int best = kBins / 3;
    double least = -1.0;
    for (int i = 0; i < kBins; ++i) {
        const int bin = (i + kBins / 3) % kBins;
        double load = 0.0;
        for (int other = 0; other < kBins; ++other) {
            const int gap = std::abs(bin - other);
            const int round = std::min(gap, kBins - gap);
            load += area_at[static_cast<std::size_t>(other)] / (1.0 + round * round);
        }
        if (least < 0.0 || load < least * (1.0 - 1e-9)) {
            least = load;
            best = bin;
        }
    }
    return best;
}

}  // namespace

Vec3 lattice_shift(const TriangleMesh& mesh, const VoxelGrid& grid, const WallLimits& limits) {
    std::array<Histogram, 3> area_at{};
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions_mm[t[0]];
        const Vec3 n = (mesh.positions_mm[t[1]] - a).cross(mesh.positions_mm[t[2]] - a);
        const double area = n.norm();
        for (int axis = 0; axis < 3; ++axis) {
            if (!(std::abs(n[axis]) > kSquare * area)) continue;
            const double at = (a[axis] - grid.origin_mm[axis]) / grid.voxel_mm;
            const double outward = n[axis] > 0.0 ? 1.0 : -1.0;
            for (const double offset : {limits.upper, limits.lower})
                if (std::isfinite(offset))
                    add_plane(area_at[static_cast<std::size_t>(axis)], at + outward * offset, area);
            if (!limits.signed_distance)
                add_plane(area_at[static_cast<std::size_t>(axis)], at - outward * limits.upper, area);
        }
    }
    Vec3 shift;
    for (int axis = 0; axis < 3; ++axis)
        shift[axis] = (emptiest(area_at[static_cast<std::size_t>(axis)]) + 0.5) / kBins;
    return shift;
}

}  // namespace fretwork
