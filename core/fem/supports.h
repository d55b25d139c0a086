// What holds an object, in parts that can be taken away one at a time.
#pragma once

#include <string>
#include <vector>

#include "core/fem/force_profile.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Something that holds: a region of the user's, or a foot the object stands on.
struct Support {
    std::string name;
    std::vector<VoxelIndex> voxels;  ///< ascending
};

/// Fixed voxels by the patches in which they hang together on the surface. A patch of less than a twentieth of the
/// largest one is no support of its own: it belongs to the one whose middle is nearest.
/// \param fixed  ascending
/// \return in the order of their lowest voxels, named after their middles
std::vector<Support> support_clusters(const SurfaceVoxels& shell, const std::vector<VoxelIndex>& fixed);

/// The case once without each of its supports, held by all the others. A support is not taken away where a component
/// of the mesh would be left without any.
/// \param supports  whose union holds in `load_case`
std::vector<LoadCase> cases_without_a_support(const SurfaceVoxels& shell, const LoadCase& load_case,
                                              const std::vector<Support>& supports);

}  // namespace fretwork
