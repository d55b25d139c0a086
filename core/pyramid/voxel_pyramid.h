// Stage 2: the shell at halved resolutions, V^0 (finest) .. V^L (coarsest).
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/bulk_vector.h"
#include "core/base/fixed_point.h"
#include "core/base/run_control.h"
#include "core/base/vec.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Eight neighbours of one entry, for loops that take eight at a time. Offsets are laid flat (see Neighborhoods), in
/// 1/4096 of a cell of the level, at most 8 cells. Unused lanes name the entry itself, with offsets of zero.
struct alignas(32) NeighborBlock {
    std::int32_t out_xy[8];   ///< x in the lower half, y in the upper: to the neighbour, in the entry's tangent plane
    std::int32_t back_xy[8];  ///< from the neighbour to the entry, in the neighbour's tangent plane
    std::int32_t z[8];        ///< of `out` in the lower half, of `back` in the upper
    VoxelIndex neighbor[8];
};

/// N(v): the voxels of the 5x5x5 cube around v that are reached from v in at most two steps over the
/// adjacency, neither of which turns round to an opposing normal; v itself left out. w is in N(v) exactly
/// when v is in N(w), and the way back of one is the way out of the other. Neighbours ascend.
///
/// The way from v to a neighbour is laid flat into v's tangent plane: its length is kept, so that a crease
/// between the two is unfolded.
///
/// Two links span the cube, so on smooth surfaces these are all its voxels on the sheet of v, 39 in the mean.
struct Neighborhoods {
    /// Most neighbours of one entry that are listed; a 5x5x5 cube holds 124, more only where sheets meet in it.
    static constexpr std::uint32_t kMost = 248;

    std::vector<std::uint32_t> first;  ///< first block of each entry, and the end
    std::vector<std::uint16_t> count;  ///< |N(v)|
    BulkVector<NeighborBlock> blocks;

    [[nodiscard]] const NeighborBlock* of(VoxelIndex v) const { return blocks.data() + first[v]; }
    [[nodiscard]] VoxelIndex neighbor(VoxelIndex v, std::uint32_t i) const { return of(v)[i / 8].neighbor[i % 8]; }
    /// From v to its i-th neighbour, in cells of the level.
    [[nodiscard]] Vec3f way_out(VoxelIndex v, std::uint32_t i) const {
        const NeighborBlock& b = of(v)[i / 8];
        return in_cells(b.out_xy[i % 8], low16(b.z[i % 8]));
    }
    /// From the i-th neighbour to v, in its plane and not in that of v.
    [[nodiscard]] Vec3f way_back(VoxelIndex v, std::uint32_t i) const {
        const NeighborBlock& b = of(v)[i / 8];
        return in_cells(b.back_xy[i % 8], high16(b.z[i % 8]));
    }

  private:
    [[nodiscard]] static Vec3f in_cells(std::int32_t xy, std::int32_t z) {
        return Vec3f(static_cast<float>(low16(xy)), static_cast<float>(high16(xy)), static_cast<float>(z)) / 4096.0F;
    }
};

struct PyramidLevel {
    std::vector<VoxelCoord> coords;  ///< in cells of this level
    /// Relative to the grid's origin, in voxels of the finest level: there the point of the shell, on coarser levels
    /// the centre of the enclosed surface.
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;              ///< unit
    Adjacency adjacency;                     ///< lengths in cells of this level
    std::vector<VoxelIndex> parent;          ///< entry of the next coarser level; empty on the coarsest
    std::vector<std::uint32_t> first_child;  ///< compressed rows into `children`; empty on the finest
    std::vector<VoxelIndex> children;
    Neighborhoods neighborhoods;

    [[nodiscard]] std::size_t size() const { return coords.size(); }
};

/// levels[0] has the entries of the shell in the same order. A coarser cell is split into as many
/// entries as its children fall into connected groups, so that sheets stay apart on every level. Positions
/// and normals of a coarser level are means over the enclosed surface: those of a shell that was voxelised coarser are
/// the same (VoxelizeSettings::halvings). Its entries are adjacent when children are, or around a common neighbour as
/// in the shell.
struct VoxelPyramid {
    std::vector<PyramidLevel> levels;
};

/// \param levels  number of levels wanted, at least 1; fewer are made when a level has become a
///                single cell per component. The paper uses 8 at 256^3, 9 at 512^3.
/// Cost    linear in the voxels; about 40 neighbours of 16 bytes each per voxel.
/// \throws InvalidSetting  levels < 1.
/// \throws Cancelled       `run` asked to stop.
VoxelPyramid build_pyramid(const SurfaceVoxels& shell, int levels, const RunControl& run = {});

}  // namespace fretwork
