#include "core/solidify/wall_lattice.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

constexpr std::int32_t kCorner = 4;  ///< nodes along a corner of a block
constexpr std::size_t kCornerNodes = 64;

/// Half the diagonal between the extreme nodes of a block, and of a corner of one, in voxels.
const double kBlockRadius = 3.5 * std::sqrt(3.0);
const double kCornerRadius = 1.5 * std::sqrt(3.0);

/// For the rounding of distances to float, in voxels.
constexpr double kRounding = 1e-4;

/// Signed distances of one block. A query in the middle of the block, then of each of its 4^3 corners, bounds all
/// others.
class BlockDistances {
  public:
    BlockDistances(const WallLattice& lattice, const WallField& field, NodeValues& values)
        : lattice_(lattice), field_(field), values_(values) {}

    void measure(std::size_t block) {
        const auto first = static_cast<NodeIndex>(block * WallLattice::kBlockNodes);
        const NodeCoord base = lattice_.coord(first);
        const double to_middle = distance_to(middle(base, 8), field_.reach_voxels() + kBlockRadius);
        if (to_middle > field_.reach_voxels() + kBlockRadius) return;
        for (unsigned corner = 0; corner < 8; ++corner) {
            low_ = base;
            first_ = first;
            for (std::size_t k = 0; k < 3; ++k)
                if (((corner >> k) & 1U) != 0) {
                    low_[k] += kCorner;
                    first_ += static_cast<NodeIndex>(kCorner << (3 * k));
                }
            measure_corner();
        }
    }

  private:
    [[nodiscard]] Vec3 middle(const NodeCoord& low, int side) const {
        return lattice_.position_mm(low) + Vec3::Constant(0.5 * (side - 1) * lattice_.step_mm());
    }

    [[nodiscard]] double distance_to(const Vec3& p, double reach_voxels) const {
        return field_.tree().closest(p, reach_voxels * lattice_.step_mm()).distance_mm / lattice_.step_mm();
    }

    /// Nodes of the corner are numbered 16 z + 4 y + x.
    [[nodiscard]] NodeIndex node(std::size_t i) const {
        return first_ + static_cast<NodeIndex>(((i >> 4) << 6) + (((i >> 2) & 3) << 3) + (i & 3));
    }
    [[nodiscard]] Vec3 position(std::size_t i) const {
        return lattice_.position_mm({low_[0] + static_cast<std::int32_t>(i & 3),
                                     low_[1] + static_cast<std::int32_t>((i >> 2) & 3),
                                     low_[2] + static_cast<std::int32_t>(i >> 4)});
    }

    void measure_corner() {
        const Vec3 center = middle(low_, kCorner);
        const double to_center = distance_to(center, field_.reach_voxels() + kCornerRadius);
        if (to_center > field_.reach_voxels() + kCornerRadius) return;
        const bool signs = field_.limits().signed_distance;
        if (!signs || to_center <= kCornerRadius + kRounding) {
            measure_nodes(center, to_center, field_.reach_voxels());
            if (signs) sign_nodes();
            return;
        }
        // The surface does not come between these nodes. Beyond the wall, only those next to it matter.
        const bool inside = field_.tree().inside(center);
        const WallLimits& limits = field_.limits();
        const double reach = (inside ? -limits.lower : limits.upper) + field_.longest_edge() + kRounding;
        if (to_center > reach + kCornerRadius) return;
        measure_nodes(center, to_center, reach);
        if (inside)
            for (std::size_t i = 0; i < kCornerNodes; ++i)
                if (distance_[i] != kFar) values_.phi[node(i)] = -distance_[i];
    }

    void measure_nodes(const Vec3& center, double to_center, double reach_voxels) {
        std::uint32_t hint = SurfaceTree::kNoHint;
        for (std::size_t i = 0; i < kCornerNodes; ++i) {
            const Vec3 p = position(i);
            // A step from a neighbour adds no more than its length.
            double bound = to_center + (p - center).norm() / lattice_.step_mm();
            for (const auto& [axis, stride] : {std::pair{i & 3, 1U}, {(i >> 2) & 3, 4U}, {i >> 4, 16U}})
                if (axis > 0) bound = std::min(bound, static_cast<double>(distance_[i - stride]) + 1.0);
            const double reach = std::min(bound + kRounding, reach_voxels) * lattice_.step_mm();
            const ClosestPoint closest = field_.tree().closest(p, reach, hint);
            distance_[i] = kFar;
            if (!closest.found()) continue;
            hint = closest.triangle;
            distance_[i] = static_cast<float>(closest.distance_mm / lattice_.step_mm());
            values_.phi[node(i)] = distance_[i];
            values_.triangle[node(i)] = closest.triangle;
        }
    }

    /// Floods between neighbours that no surface can separate, as their distances add up to more than their own; one
    /// test for each part, at its node farthest from the surface.
    void sign_nodes() {
        std::array<bool, kCornerNodes> seen{};
        std::array<std::size_t, kCornerNodes> part{};
        for (std::size_t seed = 0; seed < kCornerNodes; ++seed) {
            if (seen[seed] || distance_[seed] == kFar) continue;
            std::size_t size = 1, deepest = seed;
            part[0] = seed;
            seen[seed] = true;
            for (std::size_t k = 0; k < size; ++k) {
                const std::size_t i = part[k];
                if (distance_[i] > distance_[deepest]) deepest = i;
                const auto join = [&](std::size_t j) {
                    if (seen[j] || distance_[j] == kFar || distance_[i] + distance_[j] <= 1.0001F) return;
                    seen[j] = true;
                    part[size++] = j;
                };
                for (const auto& [axis, stride] : {std::pair{i & 3, 1U}, {(i >> 2) & 3, 4U}, {i >> 4, 16U}}) {
                    if (axis > 0) join(i - stride);
                    if (axis < 3) join(i + stride);
                }
            }
            if (!field_.tree().inside(position(deepest))) continue;
            for (std::size_t k = 0; k < size; ++k) values_.phi[node(part[k])] = -distance_[part[k]];
        }
    }

    const WallLattice& lattice_;
    const WallField& field_;
    NodeValues& values_;
    NodeCoord low_{};      ///< of the corner
    NodeIndex first_ = 0;  ///< its lowest node
    std::array<float, kCornerNodes> distance_{};
};

/// Wherever an edge to a node inside the wall could start.
void sample_pattern(const WallLattice& lattice, const WallField& field, NodeValues& values, const RunControl& run) {
    parallel_chunks(lattice.node_count(), 4 * WallLattice::kBlockNodes, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        for (std::size_t i = begin; i < end; ++i) {
            const double phi = static_cast<double>(values.phi[i]);
            if (!(std::abs(phi) <= field.reach_voxels()) || field.limits().slab(phi) > field.longest_edge()) continue;
            const Vec3 p = lattice.position_mm(lattice.coord(static_cast<NodeIndex>(i)));
            const std::uint32_t triangle = values.triangle[i];
            values.pattern[i] = static_cast<float>(field.pattern_at(field.closest_on(triangle, p), triangle));
        }
    });
}

}  // namespace

WallLattice::WallLattice(const SurfaceVoxels& shell, const Vec3& shift_voxels, double reach_voxels)
    : step_mm_(shell.grid.voxel_mm) {
    const auto margin = static_cast<std::int32_t>(std::ceil(reach_voxels)) + 2;
    origin_mm_ = shell.grid.origin_mm + step_mm_ * (shift_voxels - Vec3::Constant(margin));
    for (std::size_t k = 0; k < 3; ++k) block_extent_[k] = (shell.grid.extent[k] + 2 * margin + 1) / kBlockSide + 1;
    table_.assign(static_cast<std::size_t>(block_extent_[0]) * static_cast<std::size_t>(block_extent_[1]) *
                      static_cast<std::size_t>(block_extent_[2]),
                  kNone);
    const auto slot = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
        return (static_cast<std::size_t>(z) * static_cast<std::size_t>(block_extent_[1]) +
                static_cast<std::size_t>(y)) *
                   static_cast<std::size_t>(block_extent_[0]) +
               static_cast<std::size_t>(x);
    };
    constexpr std::uint32_t wanted = 0;
    for (const VoxelCoord& c : shell.coords) {
        NodeCoord low{}, high{};
        for (std::size_t k = 0; k < 3; ++k) {
            low[k] = c[k] / kBlockSide;
            high[k] = std::min((c[k] + 2 * margin + 1) / kBlockSide, block_extent_[k] - 1);
        }
        for (std::int32_t z = low[2]; z <= high[2]; ++z)
            for (std::int32_t y = low[1]; y <= high[1]; ++y)
                for (std::int32_t x = low[0]; x <= high[0]; ++x) table_[slot(x, y, z)] = wanted;
    }
    for (std::int32_t z = 0; z < block_extent_[2]; ++z)
        for (std::int32_t y = 0; y < block_extent_[1]; ++y)
            for (std::int32_t x = 0; x < block_extent_[0]; ++x) {
                std::uint32_t& entry = table_[slot(x, y, z)];
                if (entry == kNone) continue;
                entry = static_cast<std::uint32_t>(blocks_.size());
                blocks_.push_back({x * kBlockSide, y * kBlockSide, z * kBlockSide});
            }
}

NodeCoord WallLattice::coord(NodeIndex node) const {
    const NodeCoord& base = blocks_[node / kBlockNodes];
    const auto local = static_cast<std::int32_t>(node % kBlockNodes);
    return {base[0] + (local & 7), base[1] + ((local >> 3) & 7), base[2] + (local >> 6)};
}

NodeIndex WallLattice::find(const NodeCoord& c) const {
    NodeCoord b{};
    for (std::size_t k = 0; k < 3; ++k) {
        b[k] = c[k] >> kBlockBits;
        if (b[k] < 0 || b[k] >= block_extent_[k]) return kNone;
    }
    const std::uint32_t block = table_[(static_cast<std::size_t>(b[2]) * static_cast<std::size_t>(block_extent_[1]) +
                                        static_cast<std::size_t>(b[1])) *
                                           static_cast<std::size_t>(block_extent_[0]) +
                                       static_cast<std::size_t>(b[0])];
    if (block == kNone) return kNone;
    return block * static_cast<NodeIndex>(kBlockNodes) +
           static_cast<NodeIndex>(((c[2] & 7) << 6) | ((c[1] & 7) << 3) | (c[0] & 7));
}

NodeIndex WallLattice::upper(NodeIndex node, const NodeCoord& c, unsigned mask) const {
    const auto dx = static_cast<std::int32_t>(mask & 1U), dy = static_cast<std::int32_t>((mask >> 1) & 1U),
               dz = static_cast<std::int32_t>((mask >> 2) & 1U);
    if ((c[0] & 7) + dx < 8 && (c[1] & 7) + dy < 8 && (c[2] & 7) + dz < 8)
        return node + static_cast<NodeIndex>(dx + 8 * dy + 64 * dz);
    return find({c[0] + dx, c[1] + dy, c[2] + dz});
}

NodeValues sample_wall(const WallLattice& lattice, const WallField& field, const RunControl& run) {
    NodeValues values;
    values.phi.assign(lattice.node_count(), kFar);
    values.pattern.assign(lattice.node_count(), kFar);
    values.triangle.assign(lattice.node_count(), 0);
    parallel_chunks(lattice.block_count(), 4, [&](std::size_t begin, std::size_t end) {
        for (std::size_t block = begin; block < end; ++block) {
            run.throw_if_stopped();
            BlockDistances(lattice, field, values).measure(block);
        }
    });
    sample_pattern(lattice, field, values, run);
    return values;
}

}  // namespace fretwork
