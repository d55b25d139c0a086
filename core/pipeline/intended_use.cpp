#include "core/pipeline/intended_use.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/fem/grips.h"
#include "core/fem/supports.h"
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

PatchLoad patch_of(const SurfaceVoxels& shell, const LoadOption& load, std::vector<VoxelIndex> voxels) {
    double area_mm2 = 0.0;
    for (const VoxelIndex v : voxels) area_mm2 += static_cast<double>(shell.area_mm2[v]);
    PatchLoad patch{std::move(voxels), load.force_n, load.pressure_mpa};
    if (load.normal_force_n != 0.0) {
        if (!(area_mm2 > 0.0))
            throw InvalidSetting(fmt::format("region '{}' has no area to push on; make it larger", load.region.name));
        patch.pressure_mpa += load.normal_force_n / area_mm2;
    }
    return patch;
}

/// What [[fixtures]] hold, one support each.
std::vector<Support> fixed_regions(const TriangleMesh& mesh, const SurfaceVoxels& shell, const Settings& settings,
                                   const std::vector<LoadCase>& cases, const RunControl& run) {
    std::vector<Support> regions;
    for (const FixtureOption& fixture : settings.fixtures) {
        const std::string& name = fixture.load_case;
        if (!name.empty() && std::ranges::count(cases, name, &LoadCase::name) == 0)
            throw ConstraintsNotMet(
                fmt::format("a [[fixtures]] entry names the case '{}', which has no [[loads]] entry", name));
        regions.push_back({fixture.region.name, voxels_of(mesh, shell, fixture.region, run)});
    }
    return regions;
}

/// A load case and the parts of what holds in it.
struct HeldCase {
    LoadCase load_case;
    std::vector<Support> supports;
};

/// Held by the fixtures of the case; without any, it stands on its base.
/// \param regions  of the entries of [[fixtures]]
HeldCase hold(LoadCase load_case, const std::vector<Support>& regions, const Settings& settings,
              const std::vector<Support>& feet) {
    HeldCase held{std::move(load_case), {}};
    for (std::size_t f = 0; f < regions.size(); ++f) {
        const std::string& only = settings.fixtures[f].load_case;
        if (only.empty() || only == held.load_case.name) held.supports.push_back(regions[f]);
    }
    if (held.supports.empty()) held.supports = feet;
    held.load_case.fixed.clear();
    for (const Support& support : held.supports) merge_into(held.load_case.fixed, support.voxels);
    return held;
}

std::vector<LoadCase> own_cases(const TriangleMesh& mesh, const SurfaceVoxels& shell, const Settings& settings,
                                const LoadCase& base, const RunControl& run) {
    if (settings.loads.empty())
        throw ConstraintsNotMet("structure.profile = own, but there is no [[loads]] entry; add one, or use handling");
    ForceProfile profile;
    for (const LoadOption& load : settings.loads)
        case_named(profile, load.load_case)
            .loads.push_back(patch_of(shell, load, voxels_of(mesh, shell, load.region, run)));
    // The object's weight acts in every case.
    for (LoadCase& load_case : profile.cases) load_case.acceleration_g = base.acceleration_g;
    return std::move(profile.cases);
}

/// Weights that act when the object lands; nothing where it is not dropped.
std::optional<double> drop_factor(const StructureOptions& structure) {
    if (!structure.drop_height_mm) return structure.drop_factor;
    const double factor = 1.0 + *structure.drop_height_mm / structure.drop_stop_mm;
    if (structure.drop_factor)
        throw ConstraintsNotMet(fmt::format(
            "structure.drop_factor = {:g} and structure.drop_height_mm = {:g} (a factor of {:g}) contradict; give one",
            *structure.drop_factor, *structure.drop_height_mm, factor));
    return factor;
}

void add_grips(const SurfaceVoxels& shell, const StructureOptions& structure, std::vector<LoadCase>& cases) {
    if (structure.grips == 0) return;
    std::vector<LoadCase> grips =
        grip_cases(shell, static_cast<std::size_t>(structure.grips), structure.handling_force_n);
    if (grips.empty())
        throw ConstraintsNotMet(
            fmt::format("structure.grips = {}, but no two places of the surface can be pinched; "
                        "leave it out",
                        structure.grips));
    std::ranges::move(grips, std::back_inserter(cases));
}

std::vector<LoadCase> cases_of_profile(const TriangleMesh& mesh, const SurfaceVoxels& shell, const Settings& settings,
                                       const LoadCase& base, const RunControl& run) {
    const StructureOptions& structure = settings.structure;
    const LoadProfile chosen = chosen_profile(settings);
    if (chosen == LoadProfile::kOwn) return own_cases(mesh, shell, settings, base, run);
    std::vector<LoadCase> cases = {base};
    if (chosen == LoadProfile::kHandling)
        for (LoadCase& load_case : handling_cases(shell, structure.handling_force_n, structure.fixed_share))
            cases.push_back(std::move(load_case));
    return cases;
}

ForceProfile profile_of(const std::vector<HeldCase>& held) {
    ForceProfile profile;
    for (const HeldCase& one : held) profile.cases.push_back(one.load_case);
    return profile;
}

ForceProfile with_supports_removed(const SurfaceVoxels& shell, const std::vector<HeldCase>& held) {
    ForceProfile profile = profile_of(held);
    for (const HeldCase& one : held)
        for (LoadCase& without : cases_without_a_support(shell, one.load_case, one.supports))
            profile.cases.push_back(std::move(without));
    if (profile.cases.size() == held.size())
        throw ConstraintsNotMet(
            "structure.remove_supports = true, but the object has one support only; add [[fixtures]], or leave it out");
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
    LoadCase base = gravity_case(shell, structure.gravity, structure.fixed_share);
    base.constant_per_sample =
        structure.steps.rules == ReinforceRules::kPaper && chosen_profile(settings) != LoadProfile::kOwn;
    std::vector<LoadCase> cases = cases_of_profile(mesh, shell, settings, base, run);
    if (const std::optional<double> factor = drop_factor(structure)) {
        cases.push_back(base);
        cases.back().name = "drop";
        cases.back().acceleration_g *= *factor;
    }
    add_grips(shell, structure, cases);
    const std::vector<Support> regions = fixed_regions(mesh, shell, settings, cases, run);
    const std::vector<Support> feet = support_clusters(shell, base.fixed);
    std::vector<HeldCase> held;
    for (LoadCase& load_case : cases) held.push_back(hold(std::move(load_case), regions, settings, feet));
    ForceProfile profile = structure.remove_supports ? with_supports_removed(shell, held) : profile_of(held);
    profile.worst = {structure.weak_regions, 2.0 * structure.handling_force_n};
    return profile;
}

}  // namespace fretwork
