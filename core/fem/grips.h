// Two fingers that hold an object between them, wherever it can be held so.
#pragma once

#include <cstddef>
#include <vector>

#include "core/fem/force_profile.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Pinches at places spread over the surface, as in \cite stava2012stress: two places that face away from each
/// other, the way between them within the friction cone (coefficient 0.5) of both normals. Each finger covers a patch
/// of 5 mm radius, at most a tenth of the longest side. The two forces are opposite and act along the line through the
/// middles of their patches: they sum up to no force and no moment.
/// \param most     at most so many; fewer where the object cannot be held at so many places
/// \param force_n  of each finger
/// Cost  some ten milliseconds for a shell of 150,000 voxels.
std::vector<LoadCase> grip_cases(const SurfaceVoxels& shell, std::size_t most, double force_n);

}  // namespace fretwork
