// Inside of VOXELIZE: which of the triangles in one cell belong to one sheet of the surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/vec.h"
#include "core/shell/triangle_cells.h"

namespace fretwork {

/// Splits the triangles that meet a cell into sheets: two triangles are on one sheet when a chain of
/// mesh edges, each passing through the closed cell, joins them. Holds scratch space; use one per thread.
class SheetSplitter {
  public:
    explicit SheetSplitter(const GriddedMesh& mesh) : mesh_(mesh) {}

    /// \param in_cell  triangles that meet the cell, ascending
    /// \param center   of the cell, grid coordinates
    /// \return sheet of each triangle; sheets are numbered by their lowest triangle. Valid until the next call.
    /// Cost: n log n for n triangles in the cell.
    const std::vector<std::uint32_t>& split(std::span<const std::uint32_t> in_cell, const Vec3& center);

    [[nodiscard]] std::uint32_t sheets() const { return sheets_; }

  private:
    struct EdgeUse {
        std::uint64_t edge;  ///< lower vertex << 32 | higher vertex
        std::uint32_t user;
        friend auto operator<=>(const EdgeUse&, const EdgeUse&) = default;
    };

    std::uint32_t root(std::uint32_t user);
    void join_pairwise(std::span<const std::uint32_t> in_cell, const Vec3& center);
    void join_by_sorting_edges(std::span<const std::uint32_t> in_cell, const Vec3& center);
    void join_over_edge(std::uint32_t a, std::uint32_t b, std::uint32_t from, std::uint32_t to, const Vec3& center);
    void number_sheets();

    const GriddedMesh& mesh_;
    std::vector<EdgeUse> uses_;
    std::vector<std::uint32_t> parent_;
    std::vector<std::uint32_t> sheet_;
    std::uint32_t sheets_ = 0;
};

}  // namespace fretwork
