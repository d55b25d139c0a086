// Inside of VOXELIZE: which entries of the shell are joined by the surface.
#pragma once

#include <cstdint>
#include <span>

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

/// Entries in touching cells that share a triangle.
///
/// \param rows    made from `coords`, sorted by (z, y, x); several entries may share a cell
/// Cost: linear in the entries and their triangles.
Adjacency link_shared_triangles(const CellRows& rows, std::span<const VoxelCoord> coords,
                                const EntryTriangles& triangles, const RunControl& run);

/// `direct`, and entries in touching cells that have a common neighbour in `direct` while their
/// normals do not oppose.
Adjacency link_around_common_neighbors(const CellRows& rows, std::span<const VoxelCoord> coords,
                                       std::span<const Vec3f> normals, const Adjacency& direct, const RunControl& run);

}  // namespace fretwork
