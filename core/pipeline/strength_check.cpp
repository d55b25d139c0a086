#include "core/pipeline/strength_check.h"

#include <algorithm>
#include <iterator>

#include "core/base/error.h"
#include "core/pipeline/carved_worst_cases.h"
#include "core/pipeline/intended_use.h"
#include "core/pipeline/keep_regions.h"
#include "core/pipeline/prepare_surface.h"
#include "core/pipeline/resolve_settings.h"
#include "core/shell/voxelize.h"

namespace fretwork {
namespace {

// Loads are spread over the surface's voxels: more of them than this change nothing that is felt.
constexpr int kMostSurfaceResolution = 256;

/// \param cases  the model's load cases
template <class Cases>
StrengthCheck check(const TriangleMesh& carved, const StrengthCheckSettings& settings, const RunControl& run,
                    const Cases& cases) {
    constexpr double kCoarser = 1.25;  // halves the voxels
    constexpr double kLeastResolution = 32.0;
    const double longest_mm = longest_side(carved);
    StrengthCheck check;
    check.asked_voxel_mm = settings.voxel_mm.value_or(longest_mm / settings.resolution);
    for (double voxel_mm = check.asked_voxel_mm;; voxel_mm *= kCoarser) {
        try {
            VoxelModel model = make_voxel_model(carved, voxel_mm, run.slice(0.0, 0.05));
            check.report = analyze_strength(model, cases(model), settings.analysis, run.slice(0.1, 1.0));
            check.grid = model.grid;
            check.voxels = std::move(model.voxels);
            return check;
        } catch (const MemoryLimit&) {
            check.coarser = true;
            if (longest_mm < kLeastResolution * kCoarser * voxel_mm) throw;
        }
    }
}

ForceProfile with_worst_cases(const SurfaceLoads& loads, const VoxelModel& model, const Material& material,
                              const RunControl& run) {
    ForceProfile profile = loads.profile;
    if (profile.worst.regions == 0) return profile;
    if (loads.of_carved)
        throw InvalidInput(
            "structure.weak_regions: what the pattern bears worst is looked for on the model that was carved, which "
            "is not known");
    std::ranges::move(carved_worst_cases(loads.shell, model, profile.worst, material, run),
                      std::back_inserter(profile.cases));
    return profile;
}

}  // namespace

SurfaceLoads loads_on_surface(const TriangleMesh& surface, const Settings& settings, int resolution,
                              const RunControl& run) {
    SurfaceLoads loads;
    const int cells = std::clamp(resolution, 4, kMostSurfaceResolution);
    loads.shell = voxelize(surface, {.resolution = cells}, run.slice(0.0, 0.8));
    loads.profile = intended_use(surface, loads.shell, settings, run.slice(0.8, 1.0));
    return loads;
}

SurfaceLoads loads_of_source(const TriangleMesh& model, const std::vector<NamedTriangles>& named,
                             const Settings& settings, int resolution, const RunControl& run) {
    const PreparedSurface surface =
        prepare_surface(model, settings.input, CountSelfIntersections::kNo, run.slice(0.0, 0.5));
    const Settings local = regions_on(surface, {model.triangles.size(), named}, settings);
    return loads_on_surface(surface.mesh, local, resolution, run.slice(0.5, 1.0));
}

SurfaceLoads loads_of_carved(const TriangleMesh& carved, const Settings& settings, int resolution,
                             const RunControl& run) {
    SurfaceLoads loads = loads_on_surface(carved, settings, resolution, run);
    loads.of_carved = true;
    return loads;
}

StrengthCheckSettings strength_check_settings(const Settings& settings, std::uint64_t max_memory_bytes) {
    StrengthCheckSettings check;
    check.analysis.material = material_of(settings.structure);
    check.analysis.safety_factor = settings.structure.steps.safety_factor;
    if (max_memory_bytes > 0) check.analysis.max_memory_bytes = max_memory_bytes;
    check.voxel_mm = settings.shell.voxel_mm;
    check.resolution = settings.shell.resolution.value_or(kDefaultResolution);
    return check;
}

void keep_report_only(StrengthCheck& check) {
    check.voxels = {};
    check.report.worst_factor = {};
    check.report.worst_stress_sum_pa = {};
}

StrengthCheck check_strength(const TriangleMesh& carved, const SurfaceLoads& loads,
                             const StrengthCheckSettings& settings, const RunControl& run) {
    return check(carved, settings, run, [&](const VoxelModel& model) {
        return cases_of(with_worst_cases(loads, model, settings.analysis.material, run), loads.shell, model, run);
    });
}

StrengthCheck check_own_weight(const TriangleMesh& carved, double fixed_share, const StrengthCheckSettings& settings,
                               const RunControl& run) {
    return check(carved, settings, run, [&](const VoxelModel& model) { return self_weight_cases(model, fixed_share); });
}

}  // namespace fretwork
