// How many pieces a pattern falls into; the promise of one piece, counted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

struct PatternPieces {
    std::vector<std::size_t> touching;  ///< per component of the mesh: pieces over all of G_surface
    std::vector<std::size_t> firm;      ///< the same over firm links, which is what prints as one piece

    /// Every component of the mesh carries exactly one firm piece.
    [[nodiscard]] bool one_each() const;
};

/// Counts the pieces of the solid voxels on each component of the mesh. Cost: linear.
/// \throws InvalidInput  `solid` is not as long as the shell.
PatternPieces pattern_pieces(const SurfaceVoxels& shell, const SolidStates& solid);

}  // namespace fretwork
