// Closed surfaces of blocks on a rectilinear lattice: what the boxy meshes of make_meshes.h are cut from.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork::testing {

struct BlockLattice {
    std::array<std::vector<double>, 3> lines_mm;  ///< ascending planes along x, y, z; blocks lie between
    std::array<std::vector<int>, 3> cells;        ///< cells along each gap between planes
    double hole_radius_mm = 0.0;                  ///< of drilled blocks
};

/// One block: empty, solid, or solid with a round hole along one axis (the two gaps across it need equal `cells`).
struct Block {
    bool filled = false;
    int drill_axis = -1;
    static Block empty() { return {}; }
    static Block solid() { return {true, -1}; }
    static Block drilled(int axis) { return {true, axis}; }
};

/// Surface of the union of blocks, outward. Vertices are shared wherever positions agree; blocks that meet in an edge
/// or corner alone give a non-manifold edge or vertex there.
TriangleMesh block_mesh(const BlockLattice& lattice, const std::function<Block(const std::array<int, 3>&)>& block);

}  // namespace fretwork::testing
