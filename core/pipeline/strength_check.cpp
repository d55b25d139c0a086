#include "core/pipeline/strength_check.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/pipeline/intended_use.h"
#include "core/pipeline/keep_regions.h"
#include "core/pipeline/prepare_surface.h"
#include "core/pipeline/resolve_settings.h"
#include "core/shell/voxelize.h"

namespace fretwork {
namespace {

// Loads are spread over the surface's voxels: more of them than this change nothing that is felt.
constexpr int kMostSurfaceResolution = 256;

SurfaceLoads loads_on(const TriangleMesh& surface, const Settings& settings, int resolution, const RunControl& run) {
    SurfaceLoads loads;
    const int cells = std::clamp(resolution, 4, kMostSurfaceResolution);
    loads.shell = voxelize(surface, {.resolution = cells}, run.slice(0.5, 0.9));
    loads.profile = intended_use(surface, loads.shell, settings, run.slice(0.9, 1.0));
    return loads;
}

}  // namespace

SurfaceLoads loads_of_source(const TriangleMesh& model, const std::vector<NamedTriangles>& named,
                             const Settings& settings, int resolution, const RunControl& run) {
    const PreparedSurface surface =
        prepare_surface(model, settings.input, CountSelfIntersections::kNo, run.slice(0.0, 0.5));
    const Settings local = regions_on(surface, {model.triangles.size(), named}, settings);
    return loads_on(surface.mesh, local, resolution, run);
}

SurfaceLoads loads_of_carved(const TriangleMesh& carved, const Settings& settings, int resolution,
                             const RunControl& run) {
    return loads_on(carved, settings, resolution, run);
}

StrengthCheck check_strength(const TriangleMesh& carved, const std::optional<SurfaceLoads>& loads, double fixed_share,
                             const StrengthCheckSettings& settings, const RunControl& run) {
    constexpr double kCoarser = 1.25;  // halves the voxels
    constexpr double kLeastResolution = 32.0;
    const double longest_mm = longest_side(carved);
    StrengthCheck check;
    check.asked_voxel_mm = settings.voxel_mm.value_or(longest_mm / settings.resolution);
    for (double voxel_mm = check.asked_voxel_mm;; voxel_mm *= kCoarser) {
        try {
            const VoxelModel model = make_voxel_model(carved, voxel_mm, run.slice(0.0, 0.05));
            const std::vector<VoxelCase> cases =
                loads ? cases_of(loads->profile, loads->shell, model, run) : self_weight_cases(model, fixed_share);
            check.report = analyze_strength(model, cases, settings.analysis, run.slice(0.1, 1.0));
            return check;
        } catch (const MemoryLimit&) {
            check.coarser = true;
            if (longest_mm < kLeastResolution * kCoarser * voxel_mm) throw;
        }
    }
}

}  // namespace fretwork
