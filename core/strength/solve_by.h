// How the equations of all voxels are solved.
#pragma once

namespace fretwork {

enum class SolveBy {
    kChoice,     ///< whichever is faster for so many voxels
    kFactor,     ///< one Cholesky factor of the whole
    kMultigrid,  ///< conjugate gradients, preconditioned by two levels
};

}  // namespace fretwork
