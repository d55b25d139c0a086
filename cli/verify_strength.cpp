#include "cli/verify_strength.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include "cli/carve_again.h"
#include "cli/carve_model.h"
#include "cli/carve_run.h"
#include "cli/pattern_options.h"
#include "cli/render_colors.h"
#include "core/base/error.h"
#include "core/mesh/repair.h"
#include "core/pipeline/object_settings.h"
#include "core/pipeline/resolve_settings.h"
#include "core/pipeline/shell_strength.h"
#include "core/strength/strength_faults.h"
#include "formats/mesh_file.h"
#include "formats/run_source.h"
#include "formats/spec_toml_reader.h"

namespace fretwork::cli {
namespace {

/// What is known of the making of a model.
struct Known {
    std::optional<Settings> settings;  ///< none: neither a spec nor a carved 3MF
    std::vector<CarveTarget> sources;  ///< that were carved; empty: not known
    std::vector<std::string> cautions;
};

/// The settings of a carve, and the objects where the package keeps them.
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
    known.sources = open_model(std::move(request.model), request.settings, run).targets;
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
    // How the model was turned and scaled, and what of it was carved, is not the new spec's to say.
    const std::optional<InputOptions> input = known.settings ? std::optional(known.settings->input) : std::nullopt;
    known.settings = settings_of(named);
    if (input) known.settings->input = *input;
    return known;
}

/// Bodies that are judged each on its own: the objects of a 3MF that are carved by these settings, in their own
/// coordinates, in which a spec speaks; else all as one, without a key.
std::vector<CarveTarget> bodies_of(const ModelBytes& model, const TriangleMesh& mesh,
                                   const std::optional<Settings>& settings, const RunControl& run) {
    if (!settings || model.format != MeshFormat::kThreemf) {
        std::vector<CarveTarget> one(1);
        one.front().mesh = mesh;
        return one;
    }
    Settings reading = *settings;
    reading.input.ignore_required = true;
    std::vector<CarveTarget> bodies = open_model(model, reading, run).targets;
    for (CarveTarget& body : bodies) body.mesh = repair_mesh(body.mesh, {}, run).mesh;
    return bodies;
}

/// What a body was carved from; null: not known.
const CarveTarget* source_of(const CarveTarget& body, std::size_t bodies, const std::vector<CarveTarget>& sources) {
    if (bodies == 1 && sources.size() == 1) return &sources.front();
    const auto found = std::ranges::find(sources, body.key, &CarveTarget::key);
    return found != sources.end() && body.key ? &*found : nullptr;
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

/// What one body says.
struct Judged {
    std::string label;  ///< empty: the only one
    std::optional<StrengthCheck> check;
    std::optional<StressScale> stress_scale;
    std::vector<std::string> faults, cautions;
};

StressScale write_stress(const TriangleMesh& mesh, const std::vector<double>& stress_mpa,
                         const StrengthOptions& options) {
    const StressColors shown = stress_colors(stress_mpa);
    write_mesh(std::filesystem::path(options.stress_output), {mesh, shown.colors, "stress"});
    return shown.scale;
}

/// \param settings  of the whole file; none: it bears its own weight
void judge(const CarveTarget& body, const CarveTarget* source, const std::optional<Settings>& settings,
           const MeshReport& report, const StrengthOptions& options, const RunLimits& limits, const RunControl& run,
           Judged& judged) {
    const Settings own = settings ? settings_for_object(*settings, body.names()) : Settings{};
    StrengthCheckSettings checked = check_settings(own, options, limits);
    if (!settings && !options.resolution) checked.voxel_mm = unasked_voxel_mm(report);
    const RunControl placing = run.slice(0.0, 0.1), rest = run.slice(0.1, 1.0);
    std::optional<SurfaceLoads> loads;
    if (settings && source != nullptr)
        loads = loads_of_source(source->mesh, source->named_triangles, own, checked.resolution, placing);
    else if (settings)
        loads = loads_of_carved(body.mesh, own, checked.resolution, placing);
    try {
        judged.check = loads ? check_strength(body.mesh, *loads, checked, rest)
                             : check_own_weight(body.mesh, own.structure.fixed_share, checked, rest);
    } catch (const InvalidInput& error) {
        judged.cautions.push_back(fmt::format("whether it holds is not known: {}", error.what()));
        return;
    }
    if (!options.stress_output.empty())
        judged.stress_scale = write_stress(body.mesh, stress_on_triangles(body.mesh, *judged.check, run), options);
    keep_report_only(*judged.check);
    judged.faults = strength_faults(judged.check->report);
    judged.cautions = strength_cautions(judged.check->report);
    if (judged.check->coarser)
        judged.cautions.push_back(fmt::format("voxels are {:.3g} mm instead of {:.3g} mm to keep to the memory",
                                              judged.check->report.voxel_mm, judged.check->asked_voxel_mm));
}

void add_to(StrengthVerdict& verdict, Judged judged) {
    const auto take = [&](std::vector<std::string>& to, const std::vector<std::string>& from) {
        for (const std::string& text : from)
            to.push_back(judged.label.empty() ? text : fmt::format("{}: {}", judged.label, text));
    };
    take(verdict.faults, judged.faults);
    take(verdict.cautions, judged.cautions);
    if (judged.check)
        verdict.bodies.push_back(
            {judged.label, std::move(*judged.check), judged.stress_scale, std::move(judged.faults)});
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
    command
        .add_option("--stress", options.stress_output,
                    "Write the model in the colours of its stress: PLY, 3MF, OBJ, OFF, AMF or GLB")
        ->type_name("FILE")
        ->group(group);
}

const JudgedBody& weakest_of(const std::vector<JudgedBody>& bodies) {
    const auto share = [](const JudgedBody& body) {
        return body.check.report.least_factor / body.check.report.safety_factor;
    };
    return *std::ranges::min_element(bodies, {}, share);
}

StrengthVerdict verify_strength(const ModelBytes& model, const TriangleMesh& mesh, const MeshReport& report,
                                const StrengthOptions& options, const RunLimits& limits, const RunControl& run) {
    StrengthVerdict verdict;
    const Known known = what_is_known(model, options, run.slice(0.0, 0.05));
    verdict.cautions = known.cautions;
    if (report.border_edges > 0) {
        verdict.cautions.push_back("whether it holds is not known: the surface is not closed");
        return verdict;
    }
    const std::vector<CarveTarget> bodies = bodies_of(model, mesh, known.settings, run);
    if (bodies.size() > 1 && !options.stress_output.empty())
        throw InvalidSetting(fmt::format("--stress: {} objects are judged, expected one", bodies.size()));
    const RunControl judging = run.slice(0.05, 1.0);
    const auto count = static_cast<double>(bodies.size());
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const CarveTarget& body = bodies[i];
        const auto from = static_cast<double>(i);
        Judged judged;
        if (bodies.size() > 1) judged.label = label_of(body);
        judge(body, source_of(body, bodies.size(), known.sources), known.settings, report, options, limits,
              judging.slice(from / count, (from + 1.0) / count), judged);
        add_to(verdict, std::move(judged));
    }
    return verdict;
}

}  // namespace fretwork::cli
