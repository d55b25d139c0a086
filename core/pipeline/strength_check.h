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
};

/// The model that was carved, as it was read: its regions, faces and parts are those of the spec.
/// \param resolution  voxels of the surface along the longest side
/// \throws  as intended_use and prepare_surface
SurfaceLoads loads_of_source(const TriangleMesh& model, const std::vector<NamedTriangles>& named,
                             const Settings& settings, int resolution, const RunControl& run = {});

/// Where the model is not known: regions are looked for on the carved surface itself, inner and side walls included.
/// \throws InvalidSetting  a region that meets no part of it; a name of a face or part
SurfaceLoads loads_of_carved(const TriangleMesh& carved, const Settings& settings, int resolution,
                             const RunControl& run = {});

struct StrengthCheckSettings {
    StrengthSettings analysis;
    std::optional<double> voxel_mm;       ///< wins over `resolution`
    int resolution = kDefaultResolution;  ///< voxels along the longest side; range 4 to 4096
};

struct StrengthCheck {
    StrengthReport report;
    double asked_voxel_mm = 0.0;
    bool coarser = false;  ///< voxels are larger than was asked for, to keep to the memory
};

/// Voxels of the asked size, or larger ones where those would take more than the memory allows.
/// \param loads  none: self-weight in three directions, held at the lowest `fixed_share` of each piece
/// \throws  as make_voxel_model and analyze_strength; MemoryLimit where even 32 voxels are too many
StrengthCheck check_strength(const TriangleMesh& carved, const std::optional<SurfaceLoads>& loads, double fixed_share,
                             const StrengthCheckSettings& settings, const RunControl& run = {});

}  // namespace fretwork
