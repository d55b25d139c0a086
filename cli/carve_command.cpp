#include <fmt/format.h>

#include <filesystem>
#include <memory>

#include "cli/command.h"
#include "cli/files.h"
#include "cli/make_rule.h"
#include "cli/pattern_options.h"
#include "cli/result_files.h"
#include "cli/run_options.h"
#include "core/base/error.h"
#include "core/pipeline/carve.h"
#include "core/render/render.h"
#include "formats/png_writer.h"
#include "formats/report_json.h"

namespace fretwork::cli {
namespace {

struct CarveOptions {
    ModelSource model;
    std::string output, export_format;
    PatternOptions pattern;
    RunOptions run;
    std::string summary, preview, dependencies;
    bool check = false;
    bool strict = false;
};

/// Curved faces follow their surface to a tenth of a voxel.
CadMeshing meshing_for(const Settings& settings) {
    constexpr double kVoxelShare = 0.1;
    CadMeshing meshing;
    if (settings.shell.voxel_mm && !settings.input.size_mm)
        meshing.deviation_mm = kVoxelShare * *settings.shell.voxel_mm;
    else if (settings.shell.resolution)
        // The diagonal is at most sqrt(3) of the longest side.
        meshing.deviation_share = kVoxelShare / (1.74 * *settings.shell.resolution);
    return meshing;
}

/// Faces and parts that regions may name.
std::vector<NamedTriangles> named_triangles_of(const MeshFile& file) {
    std::vector<NamedTriangles> named;
    for (const auto* list : {&file.faces, &file.parts})
        for (const MeshPart& part : *list)
            if (!part.name.empty()) named.push_back({part.name, part.first_triangle, part.triangle_count});
    return named;
}

CarveInput input_of(const CarveOptions& options, const Settings& settings, std::vector<std::string>& read,
                    const RunControl& run) {
    // The exemplar first: it is quick, and most mistakes are there.
    ChosenExemplar chosen = exemplar_of(settings);
    ModelSource source = options.model;
    source.cad = meshing_for(settings);
    MeshFile file = read_model(source, run);
    if (source.path != kStream) read.push_back(source.path);
    for (const std::filesystem::path& beside : file.read_beside) read.push_back(beside.string());
    if (!options.run.quiet)
        for (const std::string& warning : file.warnings) fmt::print(stderr, "fretwork: warning: {}\n", warning);
    CarveInput input;
    input.named_triangles = named_triangles_of(file);
    input.mesh = std::move(file.mesh);
    input.model_name = options.model.path == kStream ? "standard input" : options.model.path;
    input.exemplar = std::move(chosen.exemplar);
    input.exemplar_width_mm = chosen.natural_width_mm;
    input.exemplar_name = chosen.name;
    return input;
}

// What the engine says about the model carries the model's name.
template <class Work>
auto naming_model(const CarveInput& input, const Work& work) {
    try {
        return work();
    } catch (const InvalidInput& error) {
        throw InvalidInput(fmt::format("{}: {}", input.model_name, error.what()));
    }
}

void print_warnings(const RunReport& report) {
    for (const std::string& warning : report.warnings) fmt::print(stderr, "fretwork: warning: {}\n", warning);
}

void print_checked(const RunReport& report) {
    fmt::print(
        stderr,
        "fretwork: can be carved: {} voxels of {:.3g} mm along the longest side, wall {:.3g} mm, pattern {:.3g} mm "
        "wide, features and holes from {:.3g} mm, about {:.0f} MB of memory\n",
        report.shell.resolution, report.shell.voxel_mm, report.shell.thickness_mm, report.pattern.exemplar_width_mm,
        report.mesh.min_feature_mm, static_cast<double>(report.peak_memory_bytes) / 1e6);
}

void print_done(const std::string& output, const RunReport& report) {
    fmt::print(stderr, "fretwork: {}: {} triangles, {} {}, {:.0f} % solid, stress {}, {:.1f} s\n",
               output == kStream ? "standard output" : output, report.mesh.report.triangles,
               report.pattern.components_after, report.pattern.components_after == 1 ? "piece" : "pieces",
               100.0 * report.pattern.solid_fraction, report.structure.verdict, report.seconds_total);
}

bool below_standard(const RunReport& report) {
    const MeshReport& mesh = report.mesh.report;
    return report.structure.max_pa > report.structure.allowable_pa || !mesh.closed_manifold() ||
           mesh.self_intersections > 0 || report.pattern.components_after != report.shell.components;
}

int check(const CarveOptions& options, Interrupt& interrupt) {
    const Settings settings = settings_of(options.pattern);
    const RunControl run = control_of(options.run, interrupt);
    std::vector<std::string> read;
    const CarveInput input = input_of(options, settings, read, run.slice(0.0, 0.2));
    const RunReport report =
        naming_model(input, [&] { return check_carve(input, settings, limits_of(options.run), run.slice(0.2, 1.0)); });
    if (!options.run.quiet) {
        print_warnings(report);
        print_checked(report);
    }
    if (!options.summary.empty()) put(options.summary, report_json(report), interrupt);
    return kDone;
}

std::string preview_png(const CarveResult& result, Preset preset, const RunControl& run) {
    RenderSettings picture;
    if (preset == Preset::kDraft) {
        picture.width = picture.height = 640;
        picture.samples_per_axis = 2;
    }
    return write_png(render(result.carved.mesh, result.carved.triangle_colors, picture, run));
}

int carve_command(const CarveOptions& options, Interrupt& interrupt) {
    if (options.check) return check(options, interrupt);
    if (options.output.empty()) throw InvalidSetting("no output: give -o FILE, or --check to carve nothing");
    const MeshFormat format = output_format(options.output, options.export_format);
    for (const std::string& target : {options.output, options.summary, options.preview, options.dependencies})
        check_target(target, {options.model.path, options.pattern.exemplar, options.pattern.mask});
    const Settings settings = settings_of(options.pattern);
    const RunLimits limits = limits_of(options.run);
    const RunControl run = control_of(options.run, interrupt);

    std::vector<std::string> read;
    const CarveInput input = input_of(options, settings, read, run.slice(0.0, 0.02));
    const CarveResult result =
        naming_model(input, [&] { return carve(input, settings, limits, run.slice(0.02, 0.95)); });

    const MeshBytes carved = carved_bytes(result, settings, input, options.output, format, run.slice(0.95, 0.98));
    if (!options.preview.empty())
        put(options.preview, preview_png(result, settings.synthesis.preset, run.slice(0.98, 0.995)), interrupt);
    if (!options.summary.empty()) put(options.summary, report_json(result.report), interrupt);
    if (!options.dependencies.empty()) {
        const std::vector<std::string> more = files_read(options.pattern, settings);
        read.insert(read.end(), more.begin(), more.end());
        put(options.dependencies, make_rule(options.output, read), interrupt);
    }
    // The result last: whoever sees it sees everything else too.
    if (!carved.materials_path.empty()) put(carved.materials_path, carved.materials, interrupt);
    put(options.output, carved.bytes, interrupt);
    run.checkpoint("write", 1.0);
    if (!options.run.quiet) {
        print_warnings(result.report);
        print_done(options.output, result.report);
    }
    return options.strict && below_standard(result.report) ? kBelowStandard : kDone;
}

}  // namespace

void add_carve(CLI::App& program, Action& chosen) {
    auto options = std::make_shared<CarveOptions>();
    CLI::App* command = program.add_subcommand("carve", "Carve a pattern through the shell of a model");
    command->add_option("model", options->model.path, fmt::format("The model: {}; - reads standard input", kReadable))
        ->required()
        ->type_name("IN");
    command
        ->add_option("-o,--output", options->output, fmt::format("The result: {}; - writes standard output", kWritable))
        ->type_name("OUT");
    add_pattern_flags(*command, options->pattern);
    add_setting_flags(*command, options->pattern);
    const char* files = "Files";
    command->add_option("--input-format", options->model.format, "Format of the model when the name does not tell")
        ->type_name("FORMAT")
        ->group(files);
    command->add_option("--input-unit", options->model.unit, "Unit of a model whose file names none (millimeter)")
        ->type_name("UNIT")
        ->group(files);
    command->add_option("--export-format", options->export_format, "Format of the result when the name does not tell")
        ->type_name("FORMAT")
        ->group(files);
    command->add_option("--summary", options->summary, "Write the run report, JSON (docs/report.schema.json)")
        ->type_name("FILE")
        ->group(files);
    command->add_option("--preview", options->preview, "Draw the result into a PNG")->type_name("FILE")->group(files);
    command->add_option("-d", options->dependencies, "Write a rule for make that names every file read")
        ->type_name("FILE")
        ->group(files);
    add_run_flags(*command, options->run);
    command->add_flag("--check", options->check, "Say within seconds what would not work; carve nothing")->group("Run");
    command->add_flag("--strict", options->strict, "Exit with 4 where strength or printability falls short")
        ->group("Run");
    command->footer(
        "Examples:\n"
        "  fretwork carve vase.stl --pattern cells -o vase.3mf\n"
        "  fretwork carve bunny.off --size-mm 100 --exemplar leaves.png --thickness-mm 2.4 -o bunny.3mf\n"
        "  openscad -o - --export-format off box.scad | fretwork carve - --input-format off --pattern box.toml -o "
        "box.stl");
    command->callback([options, &chosen] {
        chosen = [options](Interrupt& interrupt) { return carve_command(*options, interrupt); };
    });
}

}  // namespace fretwork::cli
