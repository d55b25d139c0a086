// The band of lattice nodes around the wall, and what is known at each.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/closest_point.h"
#include "core/shell/surface_voxels.h"
#include "core/solidify/wall_field.h"

namespace fretwork {

using NodeCoord = std::array<std::int32_t, 3>;
using NodeIndex = std::uint32_t;

/// Nodes of a cubic lattice, kept in blocks of 8^3 near the surface only. Node (i, j, k) lies at
/// origin_mm + step_mm * (i, j, k); blocks are ordered by (z, y, x), nodes in a block likewise.
class WallLattice {
  public:
    static constexpr int kBlockBits = 3;
    static constexpr std::int32_t kBlockSide = 1 << kBlockBits;
    static constexpr std::size_t kBlockNodes = 512;
    static constexpr NodeIndex kNone = ~NodeIndex{0};

    /// Blocks that come within `reach_voxels` of a surface voxel.
    WallLattice(const SurfaceVoxels& shell, const Vec3& shift_voxels, double reach_voxels);

    [[nodiscard]] std::size_t block_count() const { return blocks_.size(); }
    [[nodiscard]] std::size_t node_count() const { return blocks_.size() * kBlockNodes; }
    [[nodiscard]] double step_mm() const { return step_mm_; }

    [[nodiscard]] NodeCoord coord(NodeIndex node) const;
    [[nodiscard]] Vec3 position_mm(const NodeCoord& c) const { return origin_mm_ + step_mm_ * Vec3(c[0], c[1], c[2]); }

    /// kNone where the lattice has no block.
    [[nodiscard]] NodeIndex find(const NodeCoord& c) const;

    /// The node `mask` steps away: bit 0 is +x, bit 1 +y, bit 2 +z.
    [[nodiscard]] NodeIndex upper(NodeIndex node, const NodeCoord& c, unsigned mask) const;

  private:
    Vec3 origin_mm_ = Vec3::Zero();
    double step_mm_ = 1.0;
    NodeCoord block_extent_ = {0, 0, 0};
    std::vector<std::uint32_t> table_;
    std::vector<NodeCoord> blocks_;  ///< lowest node of each
};

/// What is known at the nodes. All lengths in voxels.
struct NodeValues {
    std::vector<float> phi;      ///< signed distance to the surface (unsigned for open ones); infinite out of reach
    std::vector<float> pattern;  ///< infinite where it does not matter
    std::vector<std::uint32_t> triangle;  ///< the closest one
};

/// Distances exactly; signs by one inside test for each group of nodes that no surface can separate; the pattern at the
/// closest surface point. Nodes that no edge joins to the wall may stay out of reach.
NodeValues sample_wall(const WallLattice& lattice, const WallField& field, const RunControl& run);

}  // namespace fretwork
