// How CAD models are broken into triangles.
#pragma once

#include <optional>

#include "core/pipeline/settings.h"

namespace fretwork {

/// How finely curved faces are broken into triangles.
struct CadMeshing {
    double deviation_share = 5e-4;            ///< largest distance from the true face, as a share of the longest side
    double angle_rad = 0.2;                   ///< largest turn of the normal along an edge
    std::optional<double> deviation_mm = {};  ///< the distance as a length in the file; goes before the share
};

/// Curved faces follow their surface to a tenth of the voxels that the settings ask for.
[[nodiscard]] CadMeshing meshing_for(const Settings& settings);

}  // namespace fretwork
