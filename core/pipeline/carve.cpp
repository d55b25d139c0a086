#include "core/pipeline/carve.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/enlarge/enlarge_features.h"
#include "core/mesh/mesh_report.h"
#include "core/pipeline/foresee.h"
#include "core/pipeline/intended_use.h"
#include "core/pipeline/keep_regions.h"
#include "core/pipeline/label_patches.h"
#include "core/pipeline/memory_use.h"
#include "core/pipeline/output_color.h"
#include "core/pipeline/prepare_surface.h"
#include "core/pipeline/resolve_settings.h"
#include "core/pipeline/settings_schema.h"
#include "core/pipeline/shell_stress.h"
#include "core/pipeline/stage_plan.h"
#include "core/pipeline/strength_rounds.h"
#include "core/pipeline/structure_loop.h"
#include "core/printability/print_faults.h"
#include "core/pyramid/voxel_pyramid.h"
#include "core/shell/voxelize.h"
#include "core/solidify/pattern_field.h"
#include "core/synthesis/synthesizer.h"

namespace fretwork {
namespace {

// The flow, with the seconds that each stage takes on a bunny of 256 voxels. The loop of Algorithm 1
// is one entry, because nobody knows how often it will turn.
std::vector<SettingAssignment> resolved_document(const Settings& settings, const ResolvedSettings& resolved) {
    Settings full = settings;
    full.shell.thickness_mm = resolved.solidify.thickness_mm;
    full.shell.side = resolved.solidify.side;
    full.shell.voxel_mm.reset();
    full.shell.resolution = resolved.voxelize.resolution;
    full.shell.halvings = resolved.voxelize.halvings;
    full.exemplar.width_mm = resolved.exemplar_width_mm / settings.synthesis.scale;
    full.synthesis.levels = resolved.pyramid_levels + resolved.voxelize.halvings;
    full.structure.youngs_modulus_mpa = resolved.material.youngs_modulus_mpa;
    full.structure.poissons_ratio = resolved.material.poissons_ratio;
    full.structure.density_kg_m3 = resolved.material.density_kg_m3;
    full.structure.strength_mpa = resolved.material.strength_z_mpa;
    full.structure.profile = chosen_profile(settings);
    full.structure.pattern_radius_mm = resolved.reinforce.pattern_radius_voxels * resolved.voxel_mm;
    full.fabrication.min_feature_mm = resolved.enlarge.min_feature_mm;
    full.fabrication.min_hole_mm = resolved.enlarge.min_hole_mm;
    return document_from(full).assignments;
}

RunReport report_of_request(const CarveInput& input, const Settings& settings) {
    RunReport report;
    report.version = version();
    report.input.model = input.model_name;
    report.input.exemplar = input.exemplar_name;
    report.seed = settings.synthesis.search.seed;
    report.regions = document_from(settings).tables;
    report.pattern.exemplar_solid_fraction = input.exemplar.solid_fraction();
    return report;
}

/// A draft is for the eye and does without what takes long to find out.
bool is_draft(const Settings& settings) {
    return settings.synthesis.preset == Preset::kDraft;
}

void note_resolved(const Settings& settings, const ResolvedSettings& resolved, RunReport& report) {
    report.settings = resolved_document(settings, resolved);
    report.shell.resolution =
        (resolved.voxelize.resolution + (1 << resolved.voxelize.halvings) - 1) >> resolved.voxelize.halvings;
    report.shell.voxel_mm = resolved.voxel_mm;
    report.shell.thickness_mm = resolved.solidify.thickness_mm;
    report.pattern.exemplar_width_mm = resolved.exemplar_width_mm;
    report.pattern.pixels_per_voxel = resolved.synthesis.pixels_per_voxel;
    report.mesh.min_feature_mm = resolved.enlarge.min_feature_mm;
    report.mesh.min_hole_mm = resolved.enlarge.min_hole_mm;
    std::ranges::copy(resolved.warnings, std::back_inserter(report.warnings));
    if (is_draft(settings) && settings.structure.verify_rounds > 0)
        report.warnings.push_back("structure.verify_rounds: a draft is not analysed in full");
}

StructureRecord structure_record(const ReinforceRecord& last) {
    StructureRecord record{last.max_score_pa, last.average_score_pa, last.median_score_pa,
                           last.p99_score_pa, last.allowable_pa,     {},
                           last.stopped_by};
    record.verdict =
        last.max_score_pa <= last.allowable_pa
            ? "within the allowable stress"
            : fmt::format("over the allowable stress by a factor of {:.2f}", last.max_score_pa / last.allowable_pa);
    return record;
}

void note_structure(const StructureLoopResult& loop, RunReport& report) {
    report.iterations = loop.records;
    report.structure = structure_record(loop.records.back());
    report.pattern.components_before = loop.components_before;
}

void warn_of_stress(RunReport& report) {
    if (report.structure.max_pa > report.structure.allowable_pa)
        report.warnings.push_back(fmt::format("stress of {:.3g} MPa is {}; a thicker wall or a larger budget helps",
                                              report.structure.max_pa * 1e-6, report.structure.verdict));
}

void note_strength(const StrengthRecord& strength, RunReport& report) {
    report.strength = strength;
    const char* way_out = strength.stopped_by == "nothing to fill" || strength.stopped_by == "no gain"
                              ? "; what lies around is solid or no help: a thicker wall is"
                              : "; more rounds or a larger structure.material_budget may help";
    for (const std::string& fault : strength.faults) report.warnings.push_back(fault + way_out);
}

void note_pattern(const SurfaceVoxels& shell, const EnlargeResult& enlarged, RunReport& report) {
    PatternRecord& pattern = report.pattern;
    pattern.solid_voxels = static_cast<std::size_t>(std::ranges::count(enlarged.solid, SolidState::kSolid));
    pattern.solid_fraction = static_cast<double>(pattern.solid_voxels) / static_cast<double>(shell.size());
    pattern.components_after = enlarged.components;
    pattern.voxels_enlarged = enlarged.voxels_enlarged;
    pattern.voxels_filled = enlarged.voxels_filled;
    pattern.islands_dropped = enlarged.islands_dropped;
    pattern.islands_joined = enlarged.islands_joined;
    if (pattern.solid_fraction > 0.97)
        report.warnings.push_back(
            "almost nothing was carved: holes are narrower than fabrication.min_hole_mm; a larger synthesis.scale "
            "helps");
}

void note_output(const CarvedMesh& carved, const MeshReport& mesh, std::size_t target_triangles, RunReport& report) {
    report.mesh.report = mesh;
    report.mesh.islands_removed = carved.islands_removed;
    report.mesh.islands_volume_mm3 = carved.islands_volume_mm3;
    if (mesh.components < report.shell.components)
        report.warnings.push_back(fmt::format("{} parts of the model touch each other and came out as {}",
                                              report.shell.components, mesh.components));
    if (mesh.components > report.shell.components)
        report.warnings.push_back(
            fmt::format("the carved mesh has {} shells for {} parts of the model: some are cavities", mesh.components,
                        report.shell.components));
    if (target_triangles > 0 && mesh.triangles > target_triangles)
        report.warnings.push_back(
            fmt::format("the carved mesh has {} triangles, more than fabrication.target_triangles = {}: with fewer it "
                        "would not stay "
                        "sound; a larger synthesis.scale makes a pattern that needs fewer",
                        mesh.triangles, target_triangles));
}

bool analyses_strength(const Settings& settings) {
    return settings.structure.verify_rounds > 0 && !is_draft(settings);
}

std::vector<PlannedStage> planned_stages(const Settings& settings) {
    std::vector<PlannedStage> stages = {{"repair", 0.3},    {"voxelize", 0.3}, {"pyramid", 0.3},  {"synthesize", 0.6},
                                        {"reinforce", 3.0}, {"enlarge", 2.0},  {"solidify", 7.5}, {"verify", 0.3}};
    if (analyses_strength(settings)) stages.insert(stages.end() - 1, {"strength", 25.0});
    if (!is_draft(settings)) stages.push_back({"printability", 1.0});
    return stages;
}

PrintRecord print_record(const TriangleMesh& carved, std::size_t bodies, const FabricationOptions& fabrication,
                         const ResolvedSettings& resolved, const RunControl& run) {
    PrintRecord record;
    record.report = printability(carved,
                                 {fabrication.layer_height_mm, fabrication.overhang_deg,
                                  resolved.enlarge.min_feature_mm, resolved.enlarge.min_hole_mm, bodies},
                                 run);
    record.faults = print_faults(record.report, fabrication.nozzle_mm);
    return record;
}

/// Colours of the file's triangles for those of the repaired mesh.
std::vector<Rgb8> kept_colors(const CarveInput& input, const std::vector<std::uint32_t>& source_triangles) {
    std::vector<Rgb8> colors;
    if (input.triangle_colors.empty()) return colors;
    if (input.triangle_colors.size() != input.mesh.triangles.size())
        throw InvalidInput(fmt::format("found {} colours, expected {}, one per triangle", input.triangle_colors.size(),
                                       input.mesh.triangles.size()));
    for (const std::uint32_t t : source_triangles) colors.push_back(input.triangle_colors[t]);
    return colors;
}

std::vector<Rgb8> voxel_colors(const SurfaceVoxels& shell, std::vector<Rgb8> pattern,
                               const std::vector<std::uint8_t>& keep, const std::vector<Rgb8>& kept) {
    for (std::size_t v = 0; !kept.empty() && v < shell.size(); ++v)
        if (keep[v] != 0) pattern[v] = kept[shell.triangles[v]];
    return pattern;
}

/// What the first synthesis made, before anything is reinforced.
CarveTrace trace_of_synthesis(const Exemplar& exemplar, const Synthesizer& synthesizer,
                              const std::vector<std::uint8_t>& keep) {
    CarveTrace trace;
    trace.first_solid =
        solid_with(exemplar, synthesizer.frames(), keep, std::vector<std::uint8_t>(keep.size(), std::uint8_t{0}));
    trace.first_colors = read_color(exemplar, synthesizer.frames());
    return trace;
}

std::size_t component_count(const SurfaceVoxels& shell) {
    return shell.components.empty() ? 0 : std::ranges::max(shell.components) + std::size_t{1};
}

}  // namespace

CarveResult carve(const CarveInput& input, const Settings& settings, const RunLimits& limits, const RunControl& run,
                  KeepTrace trace) {
    const ThreadLimit threads(limits.threads);
    StagePlan plan(planned_stages(settings), run);
    CarveResult result;
    RunReport& report = result.report = report_of_request(input, settings);

    PreparedSurface surface = plan.run("repair", [&](const RunControl& r) {
        return prepare_surface(input.mesh, settings.input,
                               is_draft(settings) ? CountSelfIntersections::kNo : CountSelfIntersections::kYes, r);
    });
    report.input.scale = surface.scale;
    report.input.mesh = surface.found;
    std::ranges::copy(surface.warnings, std::back_inserter(report.warnings));
    result.surface = std::move(surface.mesh);
    const ResolvedSettings resolved =
        resolve_settings(settings, {longest_side(result.surface), surface.open, surface.found.area_mm2},
                         exemplar_facts(input.exemplar, input.exemplar_width_mm));
    note_resolved(settings, resolved, report);
    check_memory(result.surface, resolved, limits.max_memory_bytes);
    const Settings local = regions_on(surface, {input.mesh.triangles.size(), input.named_triangles}, settings);
    const RegionField keep_field = keep_regions(result.surface, local);
    const std::vector<Rgb8> kept = kept_colors(input, surface.source_triangles);

    result.shell =
        plan.run("voxelize", [&](const RunControl& r) { return voxelize(result.surface, resolved.voxelize, r); });
    const SurfaceVoxels& shell = result.shell;
    report.shell.surface_voxels = shell.size();
    report.shell.components = component_count(shell);
    const std::vector<std::uint8_t> keep = voxels_inside(shell, keep_field, run);
    report.pattern.kept_voxels = static_cast<std::size_t>(std::ranges::count(keep, std::uint8_t{1}));
    const ForceProfile profile = intended_use(result.surface, shell, local, run);

    const VoxelPyramid pyramid =
        plan.run("pyramid", [&](const RunControl& r) { return build_pyramid(shell, resolved.pyramid_levels, r); });
    Synthesizer synthesizer(pyramid, input.exemplar, resolved.synthesis);
    plan.run("synthesize", [&](const RunControl& r) { synthesizer.synthesize(r); });
    if (trace == KeepTrace::kYes) result.trace = trace_of_synthesis(input.exemplar, synthesizer, keep);

    StructureLoopResult loop = plan.run("reinforce", [&](const RunControl& r) {
        return structure_loop(shell, input.exemplar, synthesizer, profile, resolved, keep, r);
    });
    note_structure(loop, report);
    if (!analyses_strength(settings)) warn_of_stress(report);
    result.stress_mpa = stress_on_voxels(shell, loop.solid, loop.last_scored).voxel_mpa;
    if (result.trace) result.trace->stress = design_stress(shell, result.trace->first_solid, loop);

    GeodesicLinks links;
    MadeObject made{std::move(loop.forced), synthesizer.frames(), {}, {}};
    made.enlarged = plan.run("enlarge", [&](const RunControl& r) {
        links = link_two_rings(shell, r);
        return enlarge_features(shell, links, loop.solid, keep, resolved.enlarge, r);
    });
    const auto solid_object = [&](const MadeObject& object, const RunControl& r) {
        const PatternField pattern(result.surface, shell, links, object.enlarged.solid, object.frames, input.exemplar,
                                   keep_field, r.slice(0.0, 0.1), kept);
        return solidify(result.surface, shell, pattern, resolved.solidify, r.slice(0.1, 1.0));
    };
    made.carved = plan.run("solidify", [&](const RunControl& r) { return solid_object(made, r); });
    if (analyses_strength(settings)) {
        const auto make_anew = [&](std::vector<std::uint8_t> forced, const std::vector<VoxelIndex>& added,
                                   const RunControl& r) {
            synthesizer.resynthesize(forced, added, resolved.reinforce.pattern_radius_voxels, r.slice(0.0, 0.1));
            MadeObject object{std::move(forced), synthesizer.frames(), {}, {}};
            object.enlarged =
                enlarge_features(shell, links, solid_with(input.exemplar, object.frames, keep, object.forced), keep,
                                 resolved.enlarge, r.slice(0.1, 0.3));
            object.carved = solid_object(object, r.slice(0.3, 1.0));
            return object;
        };
        StrengthRounds rounds = plan.run("strength", [&](const RunControl& r) {
            const StrengthCheckSettings check = strength_check_settings(settings, limits.max_memory_bytes);
            const SurfaceLoads loads = loads_on_surface(result.surface, local, check.resolution, r.slice(0.0, 0.02));
            return strengthen(std::move(made), shell, links, loads,
                              {settings.structure.verify_rounds, resolved.reinforce.material_budget,
                               2.0 * resolved.reinforce.pattern_radius_voxels, check},
                              make_anew, r.slice(0.02, 1.0));
        });
        note_strength(rounds.record, report);
        if (result.trace) result.trace->stress = analyzed_stress(rounds, resolved.material);
        result.stress_mpa = std::move(rounds.on_shell.stress_mpa);
        made = std::move(rounds.object);
    }
    note_pattern(shell, made.enlarged, report);
    report.pattern.reinforced_voxels = static_cast<std::size_t>(std::ranges::count(made.forced, std::uint8_t{1}));
    result.solid = std::move(made.enlarged.solid);
    result.reinforced = std::move(made.forced);
    result.voxel_colors = voxel_colors(shell, read_color(input.exemplar, made.frames), keep, kept);
    result.labels = label_patches(shell, made.frames, input.exemplar);
    result.carved = std::move(made.carved);
    const MeshReport carved = plan.run("verify", [&](const RunControl& r) {
        const MeshReport found = report_mesh(result.carved.mesh, CountSelfIntersections::kYes, r);
        r.checkpoint("verify", 1.0);
        return found;
    });
    note_output(result.carved, carved, resolved.solidify.target_triangles, report);
    if (!is_draft(settings))
        report.print = plan.run("printability", [&](const RunControl& r) {
            return print_record(result.carved.mesh, report.shell.components, settings.fabrication, resolved, r);
        });
    result.carved.triangle_colors =
        output_colors(std::move(result.carved.triangle_colors), settings.output.colour, input.exemplar);
    result.voxel_colors = output_colors(std::move(result.voxel_colors), settings.output.colour, input.exemplar);

    report.seconds = plan.take_seconds();
    report.seconds_total = plan.total_seconds();
    report.seconds_resynthesis = loop.seconds_resynthesis;
    report.peak_memory_bytes = peak_memory_bytes();
    return result;
}

namespace {

/// Of a draft, what a printer would stumble over. It does not hold the promise of least widths, which is left out. A
/// model that is metres tall, such as one in the wrong unit, is cut into thicker layers, to answer as soon.
std::vector<std::string> draft_faults(const CarveResult& draft, const FabricationOptions& fabrication,
                                      const RunControl& run) {
    constexpr std::size_t kMostLayers = 1000;
    const std::size_t layers = layer_count(draft.carved.mesh, fabrication.layer_height_mm);
    const double thicker = std::max(1.0, static_cast<double>(layers) / kMostLayers);
    PrintabilitySettings settings{thicker * fabrication.layer_height_mm, fabrication.overhang_deg};
    settings.bodies = draft.report.shell.components;
    PrintabilityReport found = printability(draft.carved.mesh, settings, run);
    found.least_solid.reset();
    std::vector<std::string> sentences = print_faults(found, fabrication.nozzle_mm);
    std::ranges::copy(print_cautions(found), std::back_inserter(sentences));
    if (layers > kMostLayers)
        sentences.push_back(fmt::format("looked at in layers of {:.2g} mm, for {} layers of {:g} mm would take long",
                                        settings.layer_height_mm, layers, fabrication.layer_height_mm));
    return sentences;
}

/// Carves a draft of the run and adds what is wrong with it to the warnings.
void try_draft(const CarveInput& input, const Settings& settings, const RunLimits& limits, const RunControl& run,
               RunReport& report) {
    constexpr std::size_t kMostTriangles = 400'000;
    if (input.mesh.triangles.size() > kMostTriangles) {
        report.warnings.push_back(
            fmt::format("the model has {} triangles, too many for a draft within seconds: strength and supports are "
                        "not looked at",
                        input.mesh.triangles.size()));
        return;
    }
    Settings quick = settings;
    apply_preset(quick, Preset::kDraft);
    const CarveResult draft = carve(input, quick, limits, run.slice(0.0, 0.9));
    report.pattern.solid_fraction = draft.report.pattern.solid_fraction;
    std::vector<std::string> sentences = draft_faults(draft, settings.fabrication, run.slice(0.9, 1.0));
    for (const std::string& warning : draft.report.warnings)
        if (std::ranges::find(report.warnings, warning) == report.warnings.end()) sentences.push_back(warning);
    for (const std::string& sentence : sentences) report.warnings.push_back("a draft: " + sentence);
}

}  // namespace

RunReport check_carve(const CarveInput& input, const Settings& settings, const RunLimits& limits,
                      const RunControl& run) {
    const ThreadLimit threads(limits.threads);
    RunReport report = report_of_request(input, settings);
    const double scale = input_scale(input.mesh, settings.input);
    report.input.scale = scale;
    const PreparedSurface surface =
        prepare_surface(input.mesh, settings.input, CountSelfIntersections::kYes, run.slice(0.0, 0.3));
    report.input.mesh = surface.found;
    std::ranges::copy(surface.warnings, std::back_inserter(report.warnings));
    const ExemplarFacts exemplar = exemplar_facts(input.exemplar, input.exemplar_width_mm);
    const ResolvedSettings resolved =
        resolve_settings(settings, {longest_side(surface.mesh), surface.open, surface.found.area_mm2}, exemplar);
    note_resolved(settings, resolved, report);
    check_memory(surface.mesh, resolved, limits.max_memory_bytes);
    report.peak_memory_bytes = estimated_peak_bytes(surface.mesh, resolved);
    if (resolved.voxelize.halvings == 0)
        std::ranges::copy(foreseen(resolved, exemplar, settings.fabrication, settings.synthesis.scale),
                          std::back_inserter(report.warnings));

    // A coarse shell is enough to see whether each region holds a part of the surface.
    VoxelizeSettings coarse = resolved.voxelize;
    coarse.resolution = std::min(coarse.resolution, 64);
    coarse.halvings = 0;
    const SurfaceVoxels shell = voxelize(surface.mesh, coarse, run.slice(0.3, 0.4));
    report.shell.components = component_count(shell);
    const Settings local = regions_on(surface, {input.mesh.triangles.size(), input.named_triangles}, settings);
    keep_regions(surface.mesh, local);
    intended_use(surface.mesh, shell, local, run);
    try_draft(input, settings, limits, run.slice(0.4, 1.0), report);
    run.checkpoint("check", 1.0);
    return report;
}

}  // namespace fretwork
