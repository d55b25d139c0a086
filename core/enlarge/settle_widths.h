// What only adds: pieces are joined, narrow holes filled, thin places widened, until all three hold. Internal to this
// folder.
#pragma once

#include <cstddef>
#include <vector>

#include "core/base/run_control.h"
#include "core/enlarge/geodesic_links.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct SettleCounts {
    std::size_t enlarged = 0;  ///< voxels made solid to join pieces and to widen thin places
    std::size_t filled = 0;    ///< and to fill narrow holes
    std::size_t joined = 0;    ///< islands
    std::size_t components = 0;
};

/// Each of the three undoes what another has settled, a little less each round. The first round looks at the whole
/// shell, later ones at what has become solid since and as far around it as it has a say.
/// \param solid                         in and out
/// \param may_fill                      voxels that may become solid; those that do are taken out
/// \param feature_voxels, hole_voxels   least widths
/// Cost  the first round linear in the links of the shell, the others in its voxels.
SettleCounts settle_widths(const SurfaceVoxels& shell, const GeodesicLinks& links, VoxelMask& solid,
                           VoxelMask& may_fill, double feature_voxels, double hole_voxels, const RunControl& run);

}  // namespace fretwork
