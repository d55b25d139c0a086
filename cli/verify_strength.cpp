#include "cli/verify_strength.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "cli/carve_again.h"
#include "cli/carve_model.h"
#include "cli/pattern_options.h"
#include "core/base/error.h"
#include "core/pipeline/resolve_settings.h"
#include "core/strength/strength_faults.h"
#include "formats/run_source.h"
#include "formats/spec_toml_reader.h"
#include "formats/threemf_objects.h"

namespace fretwork::cli {
namespace {

/// What is known of the making of a model.
struct Known {
    std::optional<Settings> settings;   ///< none: neither a spec nor a carved 3MF
    std::optional<CarveTarget> source;  ///< that was carved; none: not known, or not the only one
    std::vector<std::string> cautions;
};

/// The settings of a carve, and the object where the package keeps it and it is the only one.
Known what_package_knows(const ModelBytes& package, const RunControl& run) {
    Known known;
    RunSource made = read_run_source(package.bytes, package.name);
    if (made.model.bytes.empty()) {
        known.settings = settings_of({}, read_spec_toml(made.request_toml, package.name + ": request.toml"));
        known.cautions.push_back("the package does not keep the model: regions are looked for on the carved surface");
        return known;
    }
    CarveRequest request = request_of_run(std::move(made), package.name, "", {});
    known.settings = request.settings;
    CarveModel source = open_model(std::move(request.model), request.settings, run);
    if (source.targets.size() == 1) known.source = std::move(source.targets.front());
    return known;
}

Known what_is_known(const ModelBytes& model, const StrengthOptions& options, const RunControl& run) {
    const bool carved = model.format == MeshFormat::kThreemf && has_run_source(model.bytes, model.name);
    Known known = carved ? what_package_knows(model, run) : Known{};
    if (options.spec.empty()) return known;
    PatternOptions named;
    named.pattern = options.spec;
    if (!names_spec(named.pattern))
        throw InvalidSetting(fmt::format("--spec {}: expected the path of a spec, such as loads.toml", options.spec));
    // How the model was turned and scaled is not the new spec's to say.
    const std::optional<InputOptions> input = known.settings ? std::optional(known.settings->input) : std::nullopt;
    known.settings = settings_of(named);
    if (input) known.settings->input = *input;
    return known;
}

/// The one carved object in its own coordinates, in which the spec speaks; nothing where there are several.
std::optional<TriangleMesh> carved_object(const ModelBytes& model, const RunControl& run) {
    if (model.format != MeshFormat::kThreemf) return std::nullopt;
    ThreemfObjects found = read_threemf_objects(model.bytes, model.name, {.ignore_required = true}, run);
    if (found.objects.size() != 1) return std::nullopt;
    return std::move(found.objects.front().mesh);
}

/// Of a model that nobody has chosen voxels for: a solid body has many more than a carved one.
double unasked_voxel_mm(const MeshReport& report) {
    constexpr double kMostVoxels = 200000.0;
    const double longest_mm = (report.max_mm - report.min_mm).maxCoeff();
    return std::max(longest_mm / kDefaultResolution, std::cbrt(std::abs(report.volume_mm3) / kMostVoxels));
}

StrengthCheckSettings check_settings(const Settings& settings, const StrengthOptions& options,
                                     const RunLimits& limits) {
    StrengthCheckSettings result = strength_check_settings(settings, limits.max_memory_bytes);
    if (!options.material.empty()) {
        StructureOptions named;
        named.material = options.material;
        result.analysis.material = material_of(named);
    }
    if (options.resolution) {
        result.voxel_mm.reset();
        result.resolution = *options.resolution;
    }
    return result;
}

}  // namespace

void add_strength_flags(CLI::App& command, StrengthOptions& options) {
    const char* group = "Strength";
    command
        .add_option("--spec", options.spec,
                    "Spec with material, loads and supports (the one that a carved 3MF keeps; else its weight)")
        ->type_name("SPEC.toml")
        ->group(group);
    command.add_option("--material", options.material, "PLA, PETG, ABS, PA12 or resin (that of the spec)")
        ->type_name("NAME")
        ->group(group);
    command
        .add_option("--resolution", options.resolution,
                    fmt::format("Voxels along the longest side (those of the spec, or {})", kDefaultResolution))
        ->type_name("N")
        ->check(CLI::Range(8, 2048))
        ->group(group);
}

StrengthVerdict verify_strength(const ModelBytes& model, const TriangleMesh& mesh, const MeshReport& report,
                                const StrengthOptions& options, const RunLimits& limits, const RunControl& run) {
    StrengthVerdict verdict;
    Known known = what_is_known(model, options, run.slice(0.0, 0.05));
    verdict.cautions = std::move(known.cautions);
    const Settings settings = known.settings.value_or(Settings{});
    StrengthCheckSettings checked = check_settings(settings, options, limits);
    if (!known.settings && !options.resolution) checked.voxel_mm = unasked_voxel_mm(report);
    if (report.border_edges > 0) {
        verdict.cautions.push_back("whether it holds is not known: the surface is not closed");
        return verdict;
    }
    const std::optional<TriangleMesh> object = known.settings ? carved_object(model, run) : std::nullopt;
    const bool by_source = known.source && object;
    std::optional<SurfaceLoads> loads;
    if (by_source)
        loads = loads_of_source(known.source->mesh, known.source->named_triangles, settings, checked.resolution,
                                run.slice(0.05, 0.1));
    else if (known.settings)
        loads = loads_of_carved(mesh, settings, checked.resolution, run.slice(0.05, 0.1));
    const TriangleMesh& judged = by_source ? *object : mesh;
    try {
        const RunControl rest = run.slice(0.1, 1.0);
        verdict.check = loads ? check_strength(judged, *loads, checked, rest)
                              : check_own_weight(judged, settings.structure.fixed_share, checked, rest);
    } catch (const InvalidInput& error) {
        verdict.cautions.push_back(fmt::format("whether it holds is not known: {}", error.what()));
        return verdict;
    }
    verdict.faults = strength_faults(verdict.check->report);
    for (std::string& caution : strength_cautions(verdict.check->report))
        verdict.cautions.push_back(std::move(caution));
    if (verdict.check->coarser)
        verdict.cautions.push_back(fmt::format("voxels are {:.3g} mm instead of {:.3g} mm to keep to the memory",
                                               verdict.check->report.voxel_mm, verdict.check->asked_voxel_mm));
    return verdict;
}

}  // namespace fretwork::cli
