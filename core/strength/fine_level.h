// Stage 10b: K u over all voxels without a matrix, and its smoother. Internal to this folder and its tests.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "core/base/bulk_vector.h"
#include "core/base/parallel.h"
#include "core/strength/cube_element.h"
#include "core/strength/voxel_model.h"

namespace fretwork {

/// Whole layers of voxels. What two neighbouring slabs share are the nodes between them; slabs that are not neighbours
/// share none, so that all even ones may write at once and then all odd ones: sums do not depend on threads.
struct Slab {
    std::uint32_t first_voxel, end_voxel;
    std::uint32_t first_node, end_node;  ///< from its lowest layer of nodes to the next slab's, exclusive
};

/// Slabs of at least 2048 voxels, from even layers of the grid on.
std::vector<Slab> slabs_of(const VoxelModel& model);

/// Calls `body(slab)` for all even slabs, then for all odd ones.
template <class Body>
void for_each_slab(const std::vector<Slab>& slabs, const Body& body) {
    for (std::size_t odd = 0; odd < 2; ++odd)
        parallel_for((slabs.size() + 1 - odd) / 2, 1, [&](std::size_t i) { body(slabs[2 * i + odd]); });
}

template <class T>
using NodeValues = BulkVector<T>;  ///< x, y, z of each node in turn

/// Cost of an apply  about 15 ms for 300,000 voxels on two threads.
class FineLevel {
  public:
    /// \param fixed  per node, nonzero for those that cannot move
    FineLevel(const VoxelModel& model, const CubeElement& cube, const std::vector<std::uint8_t>& fixed);

    [[nodiscard]] std::size_t nodes() const { return around_.size(); }
    [[nodiscard]] const std::vector<Slab>& slabs() const { return slabs_; }

    /// y = K x, with y = 0 where nodes are fixed. x must be 0 there.
    void apply(const NodeValues<double>& x, NodeValues<double>& y) const;
    void apply(const NodeValues<float>& x, NodeValues<float>& y) const;
    /// y = K x also where nodes are fixed: what holds them.
    void apply_everywhere(const NodeValues<double>& x, NodeValues<double>& y) const;

    /// x += about K^-1 r by three steps of Chebyshev's iteration over the diagonal blocks of K; r becomes what remains.
    /// The same operator before and after the coarse level keeps the preconditioner symmetric.
    /// \param d, w  room for one vector each
    void smooth(NodeValues<float>& x, NodeValues<float>& r, NodeValues<float>& d, NodeValues<float>& w) const;

  private:
    template <class T>
    void add_products(const NodeValues<T>& x, NodeValues<T>& y) const;
    void invert_diagonal(const CubeElement& cube);
    void estimate_largest();
    template <class Use>
    void for_each_scaled(const NodeValues<float>& r, const Use& use) const;

    const VoxelModel& model_;
    std::vector<Slab> slabs_;
    std::array<double, 72> blocks_{};
    std::array<float, 72> blocks_float_{};
    std::vector<std::uint8_t> around_;  ///< per node: bit b is set where the voxel at bits b of its eight is solid
    std::vector<std::uint32_t> fixed_;
    std::array<std::array<float, 9>, 256> inverse_{};  ///< of the diagonal block, per value of around_
    float largest_ = 1.0F;                             ///< bound of the eigenvalues of D^-1 K
};

}  // namespace fretwork
