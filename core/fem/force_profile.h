// The intended use: what pushes where, and what holds.
#pragma once

#include <string>
#include <vector>

#include "core/base/vec.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// A force spread evenly over surface voxels.
struct PatchLoad {
    std::vector<VoxelIndex> voxels;
    Vec3 force_n = Vec3::Zero();  ///< total over the patch
    double pressure_mpa = 0.0;    ///< along the inward normal, added to the force
};

/// One right-hand side.
struct LoadCase {
    std::string name;
    Vec3 acceleration_g = Vec3::Zero();  ///< self-weight, in multiples of 9.81 m/s^2
    bool constant_per_sample =
        false;  ///< the paper's rule: the same force on every vertex instead of its share of the mass
    std::vector<PatchLoad> loads;
    std::vector<VoxelIndex> fixed;  ///< voxels that cannot move in this case
};

/// Loads that nobody knows: those that a pattern bears worst.
struct WorstCaseSettings {
    int regions = 0;       ///< weak ones that a case is looked for; 0: none
    double total_n = 0.0;  ///< of all pushes of a case
};

/// Several cases at once; an edge's score is the maximum over them.
struct ForceProfile {
    std::vector<LoadCase> cases;
    WorstCaseSettings worst = {};  ///< cases that follow from the pattern (`worst_cases.h`), besides
};

/// "(3, -2, 40) mm": for the names of cases.
std::string place_name(const Vec3& at_mm);

/// The paper's standard setting: gravity along `direction`, the lowest `fixed_share` of the height held.
LoadCase gravity_case(const SurfaceVoxels& shell, const Vec3& direction, double fixed_share = 0.1);

/// What hands do to an object, used when the user names no loads: pinching across the three axes
/// with `force_n` (free object held at its base), and a push at the top from four sides.
std::vector<LoadCase> handling_cases(const SurfaceVoxels& shell, double force_n = 10.0, double fixed_share = 0.1);

}  // namespace fretwork
