// Stage 6: one piece per component of the shell, by the shortest bridges.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/run_control.h"
#include "core/reinforce/paint_bridges.h"
#include "core/shell/components.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct ConnectedPieces {
    std::vector<VoxelIndex> covered;  ///< all voxels of the bridges and repaired contacts, ascending, without repeats
    std::size_t bridges = 0;          ///< over empty voxels
    std::size_t contacts = 0;         ///< pieces that met in an edge or a corner and now share faces
    std::size_t pieces = 0;           ///< firm pieces that there are now
};

/// Joins all solid pieces of each component of the shell into one, over firm links. Pieces are grown
/// over the empty voxels until they meet; the shortest gaps that join everything (the least spanning
/// tree of the pieces) become bridges. A gap of nothing, two pieces that meet in an edge or a corner, is
/// filled. Where a painted path hangs together by less than faces, it is drawn again along firm
/// links, so that the promise holds on every shell.
///
/// Promise  afterwards each component of the shell that had a solid voxel has one firm piece.
/// Cost     counting the pieces; only where there is something to join, shortest paths over all links.
/// \param shell_components  components of `shell.adjacency`
ConnectedPieces connect_pieces(const SurfaceVoxels& shell, const Adjacency& firm,
                               const ShellComponents& shell_components, BridgePainter& painter, DilatedPart part,
                               SolidStates& solid, const RunControl& run = {});

/// Gives each component of the shell without a solid voxel a disc around its lowest voxel to start from.
/// \return the voxels of the discs, ascending.
std::vector<VoxelIndex> seed_empty_components(const ShellComponents& shell_components, BridgePainter& painter,
                                              double radius_voxels, SolidStates& solid);

}  // namespace fretwork
