// How CAD models are broken into triangles.
#pragma once

#include <optional>

namespace fretwork {

/// How finely curved faces are broken into triangles.
struct CadMeshing {
    double deviation_share = 5e-4;            ///< largest distance from the true face, as a share of the box's diagonal
    double angle_rad = 0.2;                   ///< largest turn of the normal along an edge
    std::optional<double> deviation_mm = {};  ///< the distance as a length; goes before the share
};

}  // namespace fretwork
