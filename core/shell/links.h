// Inside of VOXELIZE: which entries of the shell are joined by the surface.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/shell/cell_rows.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Two normals oppose when their cosine is below this. A step over a right-angled edge is allowed with
/// room for skewed means; from one side of a wall to the other it is not.
inline constexpr float kOpposingCosine = -0.2f;

/// The triangles of each entry, ascending, in compressed rows.
struct EntryTriangles {
    std::vector<std::uint32_t> first;
    std::vector<std::uint32_t> triangle;

    [[nodiscard]] std::span<const std::uint32_t> of(VoxelIndex v) const {
        return {triangle.data() + first[v], triangle.data() + first[v + 1]};
    }
};

/// The entries of the cells that touch the cell of each entry, joined by the surface or not.
class TouchingEntries {
  public:
    /// `rows` must outlive this. Linear; parallel. \throws Cancelled
    TouchingEntries(const CellRows& rows, const RunControl& run);

    [[nodiscard]] const CellRows& rows() const { return rows_; }

    /// Calls `visit(w, code)` for the entries w around v, ascending; code by `CellRows::sweep`.
    template <class Visit>
    void visit(VoxelIndex v, const Visit& visit_entry) const {
        const Chunk& chunk = chunks_[v / kGrain];
        for (std::uint32_t i = chunk.first[v % kGrain]; i < chunk.first[v % kGrain + 1]; ++i)
            visit_entry(chunk.around[i].entry, static_cast<int>(chunk.around[i].code));
    }

    /// Entries per share of work.
    static constexpr std::size_t kGrain = 2048;

  private:
    struct Around {
        VoxelIndex entry;
        std::uint32_t code;
    };
    struct Chunk {
        std::array<std::uint32_t, kGrain + 1> first;
        std::vector<Around> around;
    };

    const CellRows& rows_;
    std::vector<Chunk> chunks_;
};

/// Links between entries in touching cells. Most cells around hold one entry, so that a set of cells tells the entries;
/// those in cells that hold several are also listed. Every link is stored from both ends.
struct TouchingLinks {
    std::vector<CellSet> single;       ///< cells of linked entries that have their cell for themselves
    std::vector<CellSet> several;      ///< cells of the other linked entries
    std::vector<std::uint32_t> first;  ///< compressed rows of the entries in `several`, ascending
    std::vector<VoxelIndex> in_several;

    /// Without any link.
    explicit TouchingLinks(std::size_t entries) : single(entries, 0), several(entries, 0), first(entries + 1, 0) {}

    /// Fills the rows from lists that follow each other; `first[v + 1]` holds the length of the row of v before.
    void take_lists(std::span<const std::vector<VoxelIndex>> lists);

    /// Is there a link from v to w, in the cell `code` around v?
    [[nodiscard]] bool holds(const CellRows& rows, VoxelIndex v, VoxelIndex w, int code) const;
    [[nodiscard]] std::span<const VoxelIndex> listed(VoxelIndex v) const {
        return {in_several.data() + first[v], in_several.data() + first[v + 1]};
    }
};

/// Entries in touching cells that share a triangle. Linear in the entries and their triangles; parallel.
TouchingLinks link_shared_triangles(const TouchingEntries& touching, const EntryTriangles& triangles,
                                    const RunControl& run);

/// `direct`, and entries in touching cells that have a common neighbour in `direct` while their
/// normals do not oppose. Linear; parallel.
Adjacency link_around_common_neighbors(const TouchingEntries& touching, std::span<const Vec3f> normals,
                                       const TouchingLinks& direct, const RunControl& run);

}  // namespace fretwork
