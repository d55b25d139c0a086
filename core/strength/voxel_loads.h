// Stage 10c: what pushes and what holds -> forces on nodes and held voxels.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/bulk_vector.h"
#include "core/base/run_control.h"
#include "core/fem/force_profile.h"
#include "core/strength/voxel_model.h"

namespace fretwork {

/// One right-hand side.
struct VoxelCase {
    std::string name;
    Vec3 acceleration_g = Vec3::Zero();  ///< self-weight of every voxel, in multiples of 9.81 m/s^2
    BulkVector<double> push_n;           ///< x, y, z per node; may be empty: nothing pushes
    std::vector<std::uint8_t> held;      ///< per voxel, nonzero for those that cannot move
};

/// Self-weight along x, y and -z, held at the lowest `fixed_share` of the height of each piece.
/// \param fixed_share  range (0, 1]. \throws InvalidSetting  out of range
std::vector<VoxelCase> self_weight_cases(const VoxelModel& model, double fixed_share = 0.1);

/// The cases that a pattern was designed for, on what has become of it.
/// Pushes    each surface voxel of a patch hands its share of the force, and the pressure on its area, to the corners
///           of the nearest solid voxel, more to nearer ones, also where the pattern is empty: all of the force acts.
/// Supports  voxels whose nearest surface voxel is fixed. A piece without any is held at its lowest tenth.
/// Weight    acts on every voxel; `constant_per_sample`, the paper's rule, has no meaning here.
/// Cost      about a microsecond per voxel and case with supports of its own.
/// \param shell  that the profile speaks of, in the coordinates of the model
/// \throws Cancelled  `run` asked to stop.
std::vector<VoxelCase> cases_of(const ForceProfile& profile, const SurfaceVoxels& shell, const VoxelModel& model,
                                const RunControl& run = {});

}  // namespace fretwork
