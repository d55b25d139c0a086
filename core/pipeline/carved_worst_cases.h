// A carved object and the surface it was carved from -> what it bears worst, as full analyses judge it.
#pragma once

#include <vector>

#include "core/base/run_control.h"
#include "core/fem/force_profile.h"
#include "core/fem/material.h"
#include "core/shell/surface_voxels.h"
#include "core/strength/voxel_model.h"

namespace fretwork {

/// The pattern is read off the object: surface voxels beside one of its voxels are solid, and the wall is as thick as
/// volume over area says. From there on as while carving (`worst_cases.h`), with other samples.
/// \param shell  of the model that was carved, not of the carved object: that would be solid everywhere
/// \return without the object's weight. Empty where the object is nowhere near the surface.
/// Cost  2 to 4 s at 256 voxels.
std::vector<LoadCase> carved_worst_cases(const SurfaceVoxels& shell, const VoxelModel& object,
                                         const WorstCaseSettings& settings, const Material& material,
                                         const RunControl& run = {});

}  // namespace fretwork
