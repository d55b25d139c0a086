// Stage 1: triangle mesh -> one-voxel-thick shell.
#pragma once

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct VoxelizeSettings {
    /// Voxels along the longest side of the mesh's bounding box. Range [4, 2048].
    /// The paper uses 256, and 512 for models with fine detail.
    int resolution = 256;
    /// The grid is that of `resolution`, in cells of 2^halvings voxels a side: a cell is selected exactly when one
    /// of its voxels would be, so that the shell is a coarse level of the pyramid of the finer one. Range [0, 10].
    int halvings = 0;
};

/// Selects every voxel of a regular grid that the surface passes through.
///
/// VOXELIZE in \cite dumas2015sound, section 3. A voxel is selected when its closed cube meets at
/// least one triangle, decided by the separating-axis test of \cite akenine2001triangle. A connected
/// surface gives a shell that is connected over `adjacency`.
///
/// Touch   coordinates are rounded when they are laid into the grid; what comes within 1e-9 voxels of a
///         cube counts as touching it, so that rounding cannot tear a shell. A face that lies in the
///         border between two layers selects both.
/// Grid    the box around the mesh is centred in a grid with a quarter to three quarters of a voxel to
///         spare at each end, so that outer flat faces run through the middle of a layer.
/// Sheets  the triangles that meet a cell fall into groups joined by edges that pass through the
///         cell; each group is an entry of its own.
/// Links   two entries in touching cells are adjacent when they share a triangle, or when both are
///         adjacent to a common entry that touches both and their normals do not oppose.
/// Units   millimetres in; integer voxel coordinates out. The result carries the grid that maps
///         between the two, so later stages never ask for the voxel size again.
/// Normals area-weighted mean over the surface inside the voxel, unit length. Where the patches
///         cancel (a wall thinner than one voxel, joined at its rim) the larger side decides; where no
///         triangle has an area, the entries around do.
/// Order   see SurfaceVoxels. Coordinates do not depend on the order of the triangles.
/// Cost    time grows with the voxels inside the triangles' bounding boxes; memory with the result.
///
/// \param mesh  needs neither to be closed nor manifold; vertices are told apart by index (weld
///              soups first, `core/mesh/repair.h`). Triangles of zero area add no normal.
/// \throws InvalidInput    no triangle; an index past the end; a coordinate that is not finite; a
///                         longest side outside [1e-9, 1e15] mm.
/// \throws InvalidSetting  `resolution` or `halvings` out of range.
/// \throws Cancelled       `run` asked to stop.
SurfaceVoxels voxelize(const TriangleMesh& mesh, const VoxelizeSettings& settings = {}, const RunControl& run = {});

}  // namespace fretwork
