// Which triangles meet at each edge: the table under reports, repair, components and sharp edges.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// Half-edge h = 3 t + k runs from corner k of triangle t to its next corner.
using HalfEdge = std::uint32_t;

[[nodiscard]] constexpr HalfEdge next_in_triangle(HalfEdge h) {
    return h % 3 == 2 ? h - 2 : h + 1;
}

/// All undirected edges of a mesh with their half-edges, told apart by vertex index. Sorted by lower, then upper end;
/// half-edges ascend. Half-edges from a vertex to itself belong to no edge.
/// Cost  linear; 24 bytes per half-edge while building.
class EdgeTable {
  public:
    /// Indices must be in range. \throws Cancelled  `run` asked to stop.
    explicit EdgeTable(const TriangleMesh& mesh, const RunControl& run = {});

    [[nodiscard]] std::size_t size() const { return low_.size(); }
    [[nodiscard]] std::uint32_t low(std::size_t edge) const { return low_[edge]; }
    [[nodiscard]] std::uint32_t high(std::size_t edge) const { return high_[edge]; }
    [[nodiscard]] std::span<const HalfEdge> half_edges(std::size_t edge) const {
        return {half_edges_.data() + first_[edge], half_edges_.data() + first_[edge + 1]};
    }

  private:
    std::vector<std::uint32_t> low_, high_, first_;
    std::vector<HalfEdge> half_edges_;
};

/// Where a half-edge starts and ends.
[[nodiscard]] inline std::uint32_t start_of(const TriangleMesh& mesh, HalfEdge h) {
    return mesh.triangles[h / 3][h % 3];
}
[[nodiscard]] inline std::uint32_t end_of(const TriangleMesh& mesh, HalfEdge h) {
    return mesh.triangles[h / 3][next_in_triangle(h) % 3];
}
/// Whether it runs from the lower to the higher index.
[[nodiscard]] inline bool runs_up(const TriangleMesh& mesh, HalfEdge h) {
    return start_of(mesh, h) < end_of(mesh, h);
}

}  // namespace fretwork
