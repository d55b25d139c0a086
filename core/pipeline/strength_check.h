// A carved mesh and the settings it was made by -> does it hold? The order of the steps, and how fine they are.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/base/run_control.h"
#include "core/fem/force_profile.h"
#include "core/mesh/region.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/settings.h"
#include "core/shell/surface_voxels.h"
#include "core/strength/strength.h"

namespace fretwork {

/// What pushes and what holds, on the surface that regions speak of.
struct SurfaceLoads {
    SurfaceVoxels shell;
    ForceProfile profile;
    bool of_carved = false;  ///< of the carved surface: the model is not known
};

/// The model that was carved, as it was read: its regions, faces and parts are those of the spec.
/// \param resolution  voxels of the surface along the longest side
/// \throws  as intended_use and prepare_surface
SurfaceLoads loads_of_source(const TriangleMesh& model, const std::vector<NamedTriangles>& named,
                             const Settings& settings, int resolution, const RunControl& run = {});

/// The same for a surface that is prepared already. \param settings  with regions as `regions_on` gives them
SurfaceLoads loads_on_surface(const TriangleMesh& surface, const Settings& settings, int resolution,
                              const RunControl& run = {});

/// Where the model is not known: regions are looked for on the carved surface itself, inner and side walls included.
/// \throws InvalidSetting  a region that meets no part of it; a name of a face or part
SurfaceLoads loads_of_carved(const TriangleMesh& carved, const Settings& settings, int resolution,
                             const RunControl& run = {});

struct StrengthCheckSettings {
    StrengthSettings analysis;
    std::optional<double> voxel_mm;       ///< wins over `resolution`
    int resolution = kDefaultResolution;  ///< voxels along the longest side; range 4 to 4096
};

/// What the settings of a carve ask for: its material and safety, and voxels of its size.
/// \param max_memory_bytes  0: as much as StrengthSettings takes by itself
StrengthCheckSettings strength_check_settings(const Settings& settings, std::uint64_t max_memory_bytes);

struct StrengthCheck {
    StrengthReport report;
    VoxelGrid grid;                  ///< of the voxels
    std::vector<VoxelCoord> voxels;  ///< that the report's values per voxel are of
    double asked_voxel_mm = 0.0;
    bool coarser = false;  ///< voxels are larger than was asked for, to keep to the memory
};

/// Lets go of what there is one of per voxel.
void keep_report_only(StrengthCheck& check);

/// Voxels of the asked size, or larger ones where those would take more than the memory allows.
/// Worst cases, if the profile asks for some, are those of the carved pattern, found anew.
/// \throws  as make_voxel_model and analyze_strength; MemoryLimit where even 32 voxels are too many; InvalidInput where
///          worst cases are asked for and the model is not known
StrengthCheck check_strength(const TriangleMesh& carved, const SurfaceLoads& loads,
                             const StrengthCheckSettings& settings, const RunControl& run = {});

/// The same under self-weight in three directions, held at the lowest `fixed_share` of each piece.
StrengthCheck check_own_weight(const TriangleMesh& carved, double fixed_share, const StrengthCheckSettings& settings,
                               const RunControl& run = {});

}  // namespace fretwork
