// The geodesic skeleton of the solid pattern (section 6.2.1 of the paper, figure 12).
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/enlarge/geodesic_links.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct SkeletonSettings {
    double core_radius_voxels = 2.0;  ///< voxels this far from empty are wide enough; the skeleton ends in them
    double shortest_leaf_voxels = 4.0;
    double shortest_loop_voxels = 12.0;
};

/// Floods the solid voxels from the maxima of the distance to empty downwards (watershed). The flood reaches each
/// basin through its highest pass, so that its tree is the ridge that connects the maxima. Leaves shorter than
/// `shortest_leaf_voxels` are pruned, and passes that close a loop longer than `shortest_loop_voxels` are put back.
///
/// \param distance_to_empty  in voxels; larger values than the core radius count as the core radius
/// \param wide_enough  voxels that lie in a disc of solid of the core radius: flanks of wide places, where no branch
///                     and no loop is wanted
/// \return  the skeleton's voxels outside the core, that is, where the pattern is too thin
VoxelMask ridge_skeleton(const SurfaceVoxels& shell, const VoxelMask& solid,
                         const std::vector<float>& distance_to_empty, const VoxelMask& wide_enough,
                         const SkeletonSettings& settings, const RunControl& run = {});

}  // namespace fretwork
