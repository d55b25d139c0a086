// Stage 2: the shell at halved resolutions, V^0 (finest) .. V^L (coarsest).
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/bulk_vector.h"
#include "core/base/run_control.h"
#include "core/base/vec.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// N(v): the voxels of the 5x5x5 cube around v that are reached from v in at most two steps over the
/// adjacency, neither of which turns round to an opposing normal; v itself left out. w is in N(v) exactly
/// when v is in N(w). Compressed rows like Adjacency, neighbours ascending.
///
/// Two links span the cube, so on smooth surfaces these are all its voxels on the sheet of v, 39 in the mean.
struct Neighborhoods {
    std::vector<std::uint32_t> first;
    BulkVector<VoxelIndex> neighbor;
    /// The way from v to its neighbour laid flat into v's tangent plane: its length is kept, so that
    /// a crease between the two is unfolded. In voxels of the *finest* level.
    BulkVector<Vec3f> offset;
    /// Position in these arrays of the same pair seen from the other side (w -> v).
    BulkVector<std::uint32_t> reverse;
};

struct PyramidLevel {
    std::vector<VoxelCoord> coords;  ///< in cells of this level
    std::vector<Vec3f> positions;    ///< surface point, relative to the grid's origin, in voxels of the finest level
    std::vector<Vec3f> normals;      ///< unit
    Adjacency adjacency;             ///< lengths in cells of this level
    std::vector<VoxelIndex> parent;  ///< entry of the next coarser level; empty on the coarsest
    std::vector<std::uint32_t> first_child;  ///< compressed rows into `children`; empty on the finest
    std::vector<VoxelIndex> children;
    Neighborhoods neighborhoods;

    [[nodiscard]] std::size_t size() const { return coords.size(); }
};

/// levels[0] has the entries of the shell in the same order. A coarser cell is split into as many
/// entries as its children fall into connected groups, so that sheets stay apart on every level. Positions
/// and normals of a coarser level are means over the children, weighted by the surface they enclose; its
/// entries are adjacent when children are, or around a common neighbour as in the shell.
struct VoxelPyramid {
    std::vector<PyramidLevel> levels;
};

/// \param levels  number of levels wanted, at least 1; fewer are made when a level has become a
///                single cell per component. The paper uses 8 at 256^3, 9 at 512^3.
/// Cost    linear in the voxels; about 40 neighbours of 20 bytes each per voxel.
/// \throws InvalidSetting  levels < 1.
/// \throws Cancelled       `run` asked to stop.
VoxelPyramid build_pyramid(const SurfaceVoxels& shell, int levels, const RunControl& run = {});

}  // namespace fretwork
