#include "core/pipeline/intended_use.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"
#include "core/pipeline/keep_regions.h"

namespace fretwork {
namespace {

std::vector<VoxelIndex> voxels_of(const TriangleMesh& mesh, const SurfaceVoxels& shell, const Region& region,
                                  const RunControl& run) {
    const RegionField field(mesh, {region});
    std::vector<VoxelIndex> voxels = voxel_list_inside(shell, field, run);
    if (voxels.empty())
        throw InvalidSetting(fmt::format("region '{}' holds no voxel of the surface; make it larger", region.name));
    return voxels;
}

LoadCase& case_named(ForceProfile& profile, const std::string& name) {
    const auto found = std::ranges::find(profile.cases, name, &LoadCase::name);
    if (found != profile.cases.end()) return *found;
    profile.cases.push_back({});
    profile.cases.back().name = name;
    return profile.cases.back();
}

void merge_into(std::vector<VoxelIndex>& sorted, const std::vector<VoxelIndex>& more) {
    std::vector<VoxelIndex> merged;
    std::ranges::set_union(sorted, more, std::back_inserter(merged));
    sorted = std::move(merged);
}

ForceProfile own_loads(const TriangleMesh& mesh, const SurfaceVoxels& shell, const Settings& settings,
                       const RunControl& run) {
    if (settings.loads.empty())
        throw ConstraintsNotMet("structure.profile = own, but there is no [[loads]] entry; add one, or use handling");
    ForceProfile profile;
    for (const LoadOption& load : settings.loads)
        case_named(profile, load.load_case)
            .loads.push_back({voxels_of(mesh, shell, load.region, run), load.force_n, load.pressure_mpa});
    for (const FixtureOption& fixture : settings.fixtures) {
        const bool known =
            fixture.load_case.empty() || std::ranges::count(profile.cases, fixture.load_case, &LoadCase::name) > 0;
        if (!known)
            throw ConstraintsNotMet(fmt::format(
                "a [[fixtures]] entry names the case '{}', which has no [[loads]] entry", fixture.load_case));
        const std::vector<VoxelIndex> voxels = voxels_of(mesh, shell, fixture.region, run);
        for (LoadCase& load_case : profile.cases)
            if (fixture.load_case.empty() || fixture.load_case == load_case.name) merge_into(load_case.fixed, voxels);
    }
    // The object's weight acts in every case; what nothing else holds stands on its base.
    const LoadCase base = gravity_case(shell, settings.structure.gravity, settings.structure.fixed_share);
    for (LoadCase& load_case : profile.cases) {
        load_case.acceleration_g = base.acceleration_g;
        if (load_case.fixed.empty()) load_case.fixed = base.fixed;
    }
    return profile;
}

}  // namespace

LoadProfile chosen_profile(const Settings& settings) {
    if (settings.structure.profile != LoadProfile::kAuto) return settings.structure.profile;
    if (!settings.loads.empty()) return LoadProfile::kOwn;
    return settings.structure.steps.rules == ReinforceRules::kPaper ? LoadProfile::kGravity : LoadProfile::kHandling;
}

ForceProfile intended_use(const TriangleMesh& mesh, const SurfaceVoxels& shell, const Settings& settings,
                          const RunControl& run) {
    const StructureOptions& structure = settings.structure;
    const LoadProfile chosen = chosen_profile(settings);
    if (chosen == LoadProfile::kOwn) return own_loads(mesh, shell, settings, run);
    ForceProfile profile;
    profile.cases.push_back(gravity_case(shell, structure.gravity, structure.fixed_share));
    profile.cases.front().constant_per_sample = structure.steps.rules == ReinforceRules::kPaper;
    if (chosen == LoadProfile::kHandling)
        for (LoadCase& load_case : handling_cases(shell, structure.handling_force_n, structure.fixed_share))
            profile.cases.push_back(std::move(load_case));
    return profile;
}

}  // namespace fretwork
