#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cli/command.h"
#include "cli/files.h"
#include "cli/run_options.h"
#include "cli/verify_strength.h"
#include "core/base/parallel.h"
#include "core/mesh/mesh_report.h"
#include "core/mesh/repair.h"
#include "core/pipeline/settings.h"
#include "core/printability/print_faults.h"
#include "core/printability/printability.h"
#include "core/strength/strength_faults.h"
#include "formats/facts_text.h"
#include "formats/printability_facts.h"
#include "formats/strength_facts.h"

namespace fretwork::cli {
namespace {

struct VerifyOptions {
    ModelSource model;
    FabricationOptions fabrication;
    std::optional<double> min_feature_mm, min_hole_mm;
    StrengthOptions strength;
    bool no_strength = false;
    bool json = false, strict = false;
    RunOptions run;
};

/// Objects of a plate and solids of a CAD model lie apart on purpose; groups of an OBJ or solids of an STL need not.
std::size_t bodies_in(const MeshFile& file, MeshFormat format) {
    switch (format) {
        case MeshFormat::kThreemf:
        case MeshFormat::kAmf:
        case MeshFormat::kStep:
        case MeshFormat::kIges:
        case MeshFormat::kBrep:
            return std::max<std::size_t>(file.parts.size(), 1);
        default:
            return 1;
    }
}

PrintabilitySettings settings_of(const VerifyOptions& options, std::size_t bodies) {
    const double two_lines = 2.0 * options.fabrication.nozzle_mm;
    return {options.fabrication.layer_height_mm, options.fabrication.overhang_deg,
            options.min_feature_mm.value_or(two_lines), options.min_hole_mm.value_or(two_lines), bodies};
}

/// Faults of the surface itself, in words.
std::vector<std::string> mesh_faults(const MeshReport& mesh) {
    std::vector<std::string> faults;
    const auto add = [&](std::size_t found, const char* what) {
        if (found > 0) faults.push_back(fmt::format("{} {}", found, what));
    };
    add(mesh.border_edges, "edges have a triangle on one side only");
    add(mesh.non_manifold_edges, "edges have more than two triangles");
    add(mesh.flipped_edges, "edges have triangles that run against each other");
    add(mesh.self_intersections, "pairs of triangles intersect");
    return faults;
}

/// Of several bodies the weakest stands first, and then what all of them came to.
void add_verdict(const StrengthVerdict& strength, Facts& facts) {
    if (strength.bodies.empty()) return;
    const JudgedBody& weakest = weakest_of(strength.bodies);
    if (!weakest.label.empty()) facts.add("strength.object", weakest.label);
    add_strength_facts(weakest.check, weakest.faults, "strength.", facts);
    if (weakest.stress_scale)
        facts.add("strength.stress_scale_mpa",
                  std::vector<double>{weakest.stress_scale->low_mpa, weakest.stress_scale->high_mpa});
    if (weakest.label.empty()) return;
    std::vector<Facts> objects;
    for (const JudgedBody& body : strength.bodies) {
        Facts& own = objects.emplace_back();
        own.add("object", body.label);
        add_strength_facts(body.check, body.faults, "", own);
    }
    facts.add("strength.objects", objects);
}

int verify_command(const VerifyOptions& options, Interrupt& interrupt) {
    const ThreadLimit threads(options.run.threads);
    const RunControl run = control_of(options.run, interrupt);
    const RunControl reading = run.slice(0.0, 0.2);
    const ModelBytes model = read_bytes(options.model, reading);
    const MeshFile file = read_model(model, options.model.cad, reading);
    if (!options.run.quiet) print_warnings(file);
    // Vertices of formats that know none are joined; nothing else changes in a sound mesh.
    const TriangleMesh mesh = repair_mesh(file.mesh, {}, run.slice(0.2, 0.3)).mesh;
    const MeshReport report = report_mesh(mesh, CountSelfIntersections::kYes, run.slice(0.3, 0.5));
    const PrintabilityReport print = printability(mesh, settings_of(options, bodies_in(file, model.format)),
                                                  run.slice(0.5, options.no_strength ? 1.0 : 0.6));
    StrengthVerdict strength;
    if (!options.no_strength)
        strength = verify_strength(model, mesh, report, options.strength, limits_of(options.run), run.slice(0.6, 1.0));
    std::vector<std::string> faults = mesh_faults(report);
    for (std::string& fault : print_faults(print, options.fabrication.nozzle_mm)) faults.push_back(std::move(fault));
    const std::vector<std::string> printing = faults;
    faults.insert(faults.end(), strength.faults.begin(), strength.faults.end());
    std::vector<std::string> cautions = print_cautions(print);
    cautions.insert(cautions.end(), strength.cautions.begin(), strength.cautions.end());

    Facts facts;
    facts.add("file", options.model.path);
    facts.add("sound", faults.empty());
    add_mesh_facts(report, facts);
    add_printability_facts(print, printing, "printability.", facts);
    add_verdict(strength, facts);
    fmt::print("{}", options.json ? facts_json(facts) : facts_lines(facts));
    if (!options.run.quiet) {
        for (const std::string& fault : faults) fmt::print(stderr, "fretwork: fault: {}\n", fault);
        for (const std::string& caution : cautions) fmt::print(stderr, "fretwork: note: {}\n", caution);
    }
    return options.strict && !faults.empty() ? kBelowStandard : kDone;
}

}  // namespace

void add_verify(CLI::App& program, Action& chosen) {
    auto options = std::make_shared<VerifyOptions>();
    CLI::App* command = program.add_subcommand(
        "verify", "Say whether a model prints, layer by layer, and holds, voxel by voxel, and what is against it");
    command->add_option("model", options->model.path, fmt::format("The model: {}; - reads standard input", kReadable))
        ->required()
        ->type_name("FILE");
    command->add_flag("--json", options->json, "As JSON instead of key = value lines");
    const char* printer = "Printer";
    const auto number = [&](const char* flag, double& value, const char* help) {
        command->add_option(flag, value, fmt::format("{} ({:g})", help, value))->type_name("NUMBER")->group(printer);
    };
    number("--layer-height", options->fabrication.layer_height_mm, "Height of a layer, mm");
    number("--nozzle", options->fabrication.nozzle_mm, "Width of a printed line, mm");
    number("--overhang", options->fabrication.overhang_deg, "Lean from the vertical that needs no support, degrees");
    command->add_option("--min-feature", options->min_feature_mm, "Narrower solid is listed, mm (two lines)")
        ->type_name("NUMBER")
        ->group(printer);
    command->add_option("--min-hole", options->min_hole_mm, "Narrower gaps are listed, mm (two lines)")
        ->type_name("NUMBER")
        ->group(printer);
    add_strength_flags(*command, options->strength);
    command->add_flag("--no-strength", options->no_strength, "Leave out whether it holds")->group("Strength");
    add_ignore_required_flag(*command, options->model);
    command->add_option("--input-format", options->model.format, "Format of the model when the name does not tell")
        ->type_name("FORMAT");
    command->add_option("--input-unit", options->model.unit, "Unit of a model whose file names none (millimeter)")
        ->type_name("UNIT");
    command->add_flag("--strict", options->strict, "Exit with 4 where there is a fault");
    add_run_flags(*command, options->run);
    command->footer("Example:\n  fretwork verify carved.3mf --nozzle 0.4 --layer-height 0.2");
    command->callback([options, &chosen] {
        chosen = [options](Interrupt& interrupt) { return verify_command(*options, interrupt); };
    });
}

}  // namespace fretwork::cli
