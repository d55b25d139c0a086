// Inside of the pyramid: the neighbourhoods N(v) of one level, and the ways to the neighbours laid flat.
#pragma once

#include "core/base/run_control.h"
#include "core/pyramid/voxel_pyramid.h"

namespace fretwork {

/// Needs coords, positions, normals and adjacency of `level`.
///
/// Offsets  where the two normals and those on the way between them are alike, w - v is turned into v's
///          tangent plane and stretched from the chord to the arc. Around a sharp edge, w is turned into the plane
///          of v about the line where the two tangent planes meet, which is exact between flat faces. Around a
///          rounded edge, the way over the entry between v and w that bends least is unfolded in two steps, and
///          the second one carried back to v by the rotation that takes one normal to the other.
/// Cost     linear in the pairs, about 39 per entry.
/// \param level_index  0 for the finest level, whose voxels are the unit of the positions
Neighborhoods find_neighborhoods(const PyramidLevel& level, int level_index, const RunControl& run);

}  // namespace fretwork
