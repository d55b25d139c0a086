#include "core/solidify/wall_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// Half the diagonal between the extreme nodes of a block, and of a 4^3 corner of one, in voxels.
const double kBlockRadius = 3.5 * std::sqrt(3.0);
const double kCornerRadius = 1.5 * std::sqrt(3.0);

/// Distances of one block. A query in the middle of the block, then of each of its 4^3 corners, bounds all others.
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
            NodeCoord low = base;
            for (std::size_t k = 0; k < 3; ++k) low[k] += ((corner >> k) & 1U) != 0 ? 4 : 0;
            measure_corner(low, first, base);
        }
    }

  private:
    [[nodiscard]] Vec3 middle(const NodeCoord& low, int side) const {
        return lattice_.position_mm(low) + Vec3::Constant(0.5 * (side - 1) * lattice_.step_mm());
    }

    [[nodiscard]] double distance_to(const Vec3& p, double reach_voxels) const {
        return field_.tree().closest(p, reach_voxels * lattice_.step_mm()).distance_mm / lattice_.step_mm();
    }

    void measure_corner(const NodeCoord& low, NodeIndex first, const NodeCoord& base) {
        const Vec3 center = middle(low, 4);
        const double to_center = distance_to(center, field_.reach_voxels() + kCornerRadius);
        if (to_center > field_.reach_voxels() + kCornerRadius) return;
        for (std::int32_t z = 0; z < 4; ++z)
            for (std::int32_t y = 0; y < 4; ++y)
                for (std::int32_t x = 0; x < 4; ++x) {
                    const NodeCoord c = {low[0] + x, low[1] + y, low[2] + z};
                    const Vec3 p = lattice_.position_mm(c);
                    const double bound = to_center + (p - center).norm() / lattice_.step_mm() + 1e-6;
                    const double reach = std::min(bound, field_.reach_voxels()) * lattice_.step_mm();
                    const ClosestPoint closest = field_.tree().closest(p, reach);
                    if (!closest.found()) continue;
                    const NodeIndex node =
                        first +
                        static_cast<NodeIndex>(((c[2] - base[2]) * 8 + (c[1] - base[1])) * 8 + (c[0] - base[0]));
                    values_.phi[node] = static_cast<float>(closest.distance_mm / lattice_.step_mm());
                    values_.triangle[node] = closest.triangle;
                }
    }

    const WallLattice& lattice_;
    const WallField& field_;
    NodeValues& values_;
};

/// Parts of the band that no surface separates: two neighbours whose distances add up to more than their own distance
/// are on one side. Returns the part of each node and, per part, its node farthest from the surface.
struct Parts {
    std::vector<std::uint32_t> of_node;
    std::vector<NodeIndex> deepest;
};

Parts flood_parts(const WallLattice& lattice, const std::vector<float>& distance, const RunControl& run) {
    constexpr std::uint32_t none = ~std::uint32_t{0};
    Parts parts;
    parts.of_node.assign(lattice.node_count(), none);
    std::vector<NodeIndex> stack;
    for (NodeIndex seed = 0; seed < lattice.node_count(); ++seed) {
        if (distance[seed] == kFar || parts.of_node[seed] != none) continue;
        const auto part = static_cast<std::uint32_t>(parts.deepest.size());
        NodeIndex deepest = seed;
        parts.of_node[seed] = part;
        stack.assign(1, seed);
        run.throw_if_stopped();
        while (!stack.empty()) {
            const NodeIndex node = stack.back();
            stack.pop_back();
            if (distance[node] > distance[deepest]) deepest = node;
            const NodeCoord c = lattice.coord(node);
            for (std::size_t axis = 0; axis < 3; ++axis)
                for (const std::int32_t step : {-1, 1}) {
                    NodeCoord d = c;
                    d[axis] += step;
                    const NodeIndex next = lattice.find(d);
                    if (next == WallLattice::kNone || parts.of_node[next] != none || distance[next] == kFar) continue;
                    if (distance[node] + distance[next] <= 1.0001F) continue;
                    parts.of_node[next] = part;
                    stack.push_back(next);
                }
        }
        parts.deepest.push_back(deepest);
    }
    return parts;
}

void sign_distances(const WallLattice& lattice, const WallField& field, NodeValues& values, const RunControl& run) {
    const Parts parts = flood_parts(lattice, values.phi, run);
    std::vector<std::uint8_t> inside(parts.deepest.size());
    parallel_chunks(inside.size(), 256, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        for (std::size_t p = begin; p < end; ++p)
            inside[p] = field.tree().inside(lattice.position_mm(lattice.coord(parts.deepest[p]))) ? 1 : 0;
    });
    for (std::size_t node = 0; node < values.phi.size(); ++node)
        if (values.phi[node] != kFar && inside[parts.of_node[node]] != 0) values.phi[node] = -values.phi[node];
}

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
    if (field.limits().signed_distance) sign_distances(lattice, field, values, run);
    sample_pattern(lattice, field, values, run);
    return values;
}

}  // namespace fretwork
