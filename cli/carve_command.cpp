#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "cli/carve_again.h"
#include "cli/carved_output.h"
#include "cli/command.h"
#include "cli/files.h"
#include "cli/make_rule.h"
#include "cli/pattern_options.h"
#include "cli/printer_room.h"
#include "cli/report_page.h"
#include "cli/run_options.h"
#include "cli/scad_model.h"
#include "cli/slicing.h"
#include "core/base/error.h"
#include "formats/color_channel.h"
#include "formats/spec_toml_reader.h"
#include "formats/threemf_editor.h"

namespace fretwork::cli {
namespace {

struct CarveOptions {
    ModelSource model;
    std::string output, export_format;
    PatternOptions pattern;
    std::vector<std::string> objects;
    std::string paint;
    std::optional<int> extruders;
    bool no_thumbnail = false, no_source = false, ignore_required = false;
    bool again = false;
    std::string source;
    RunOptions run;
    std::string summary, report, preview, dependencies;
    bool check = false;
    bool strict = false;
    bool verify_and_reinforce = false;
    std::string slice;  ///< profile
};

constexpr int kVerifyRounds = 8;

/// The flags of this command that stand for keys of a spec.
PatternOptions with_own_flags(const CarveOptions& options) {
    PatternOptions pattern = options.pattern;
    const auto set = [&](const std::string& key, const std::string& value) {
        pattern.assignments.push_back(key + "=" + value);
    };
    if (!options.objects.empty()) set("input.objects", fmt::format("{}", fmt::join(options.objects, ",")));
    if (options.ignore_required) set("input.ignore_required", "true");
    if (options.no_thumbnail) set("output.thumbnail", "false");
    if (options.no_source) set("output.source", "false");
    if (!options.paint.empty()) set("output.paint", options.paint);
    if (options.verify_and_reinforce) set("structure.verify_rounds", std::to_string(kVerifyRounds));
    if (options.extruders) set("output.extruders", std::to_string(*options.extruders));
    return pattern;
}

/// The file's own spec is the first word, then its marks, then a spec of --pattern, flags last.
CarveRequest request_of_scad(const std::string& path, PatternOptions pattern, const RunControl& run) {
    const ScadOptions scad_options = take_scad_options(pattern);
    pattern.parameters_of_model = true;
    ScadModel scad = render_scad(path, scad_options, ScadMarks::kRender, run);
    SpecDocument document;
    if (scad.spec) document = anchored(path, read_spec_toml(*scad.spec, scad.model.name));
    std::ranges::move(scad.marks, std::back_inserter(document.tables));
    const SpecDocument more = spec_of(pattern);
    document.assignments.insert(document.assignments.end(), more.assignments.begin(), more.assignments.end());
    document.tables.insert(document.tables.end(), more.tables.begin(), more.tables.end());
    CarveRequest request;
    request.settings = settings_of(pattern, std::move(document));
    request.model = std::move(scad.model);
    return request;
}

CarveRequest request_of(const CarveOptions& options, const RunControl& run) {
    const PatternOptions pattern = with_own_flags(options);
    if (options.again) return request_of_package(read_bytes(options.model), options.source, pattern);
    if (!options.source.empty()) throw InvalidSetting("--source goes with --again");
    if (is_scad(options.model)) return request_of_scad(options.model.path, pattern, run);
    CarveRequest request;
    request.settings = settings_of(pattern);
    // Before the model is read: it is quick, and most mistakes are there.
    if (request.settings.objects.empty()) exemplar_of(request.settings, request.pictures);
    request.model = read_bytes(options.model);
    return request;
}

/// Everything that a run of this command starts from.
struct Opened {
    CarveRequest request;
    CarveModel model;
};

Opened open(const CarveOptions& options, const RunControl& run) {
    Opened opened{request_of(options, run), {}};
    opened.model = open_model(std::move(opened.request.model), opened.request.settings, run);
    std::ranges::copy(opened.request.sources, std::back_inserter(opened.model.read_beside));
    if (options.run.quiet) return opened;
    for (const auto* warnings : {&opened.request.warnings, &opened.model.warnings})
        for (const std::string& warning : *warnings) fmt::print(stderr, "fretwork: warning: {}\n", warning);
    return opened;
}

/// Opens the package of a 3MF for its carved objects, and tells what cannot be kept of them: found out early whether it
/// can be written at all. None where the model is no 3MF.
std::unique_ptr<ThreemfEditor> open_package(const CarveOptions& options, const CarveModel& model) {
    if (!model.targets.front().key) return nullptr;
    std::vector<threemf::ObjectKey> keys;
    for (const CarveTarget& target : model.targets) keys.push_back(*target.key);
    auto editor = std::make_unique<ThreemfEditor>(model.file.bytes, model.file.name, keys);
    if (options.run.quiet) return editor;
    for (const std::string& warning : editor->warnings()) fmt::print(stderr, "fretwork: warning: {}\n", warning);
    return editor;
}

void print_paint(const PaintRecord& paint) {
    for (std::size_t i = 0; i < paint.extruders.size(); ++i)
        fmt::print(stderr, "fretwork: extruder {} prints {}\n", i + 1, hex_color(paint.extruders[i]));
}

/// In front of what is said about one of several objects.
std::string prefix_of(const CarveModel& model, std::size_t i) {
    return model.targets.size() > 1 ? label_of(model.targets[i]) + ": " : "";
}

void print_warnings(const CarveModel& model, const std::vector<RunReport>& reports) {
    for (std::size_t i = 0; i < reports.size(); ++i) {
        for (const std::string& warning : reports[i].warnings)
            fmt::print(stderr, "fretwork: warning: {}{}\n", prefix_of(model, i), warning);
        if (!reports[i].print) continue;
        for (const std::string& fault : reports[i].print->faults)
            fmt::print(stderr, "fretwork: warning: {}print: {}\n", prefix_of(model, i), fault);
    }
}

void print_checked(const std::string& prefix, const RunReport& report) {
    const double fraction = report.pattern.solid_fraction;  // of a draft, if there was one
    const std::string solid = fraction > 0.0 ? fmt::format(", about {:.0f} % solid", 100.0 * fraction) : "";
    fmt::print(
        stderr,
        "fretwork: {}can be carved: {} voxels of {:.3g} mm along the longest side, wall {:.3g} mm, pattern {:.3g} mm "
        "wide, features from {:.3g} mm, holes from {:.3g} mm{}, about {:.0f} MB of memory\n",
        prefix, report.shell.resolution, report.shell.voxel_mm, report.shell.thickness_mm,
        report.pattern.exemplar_width_mm, report.mesh.min_feature_mm, report.mesh.min_hole_mm, solid,
        static_cast<double>(report.peak_memory_bytes) / 1e6);
}

void print_done(const std::string& output, const std::string& prefix, const RunReport& report) {
    // Parts of the model that touch come out as one.
    const std::size_t pieces = std::min(report.pattern.components_after, report.mesh.report.components);
    const std::string verdict = report.strength
                                    ? fmt::format("factor of safety {:.3g}", report.strength->check.report.least_factor)
                                    : "stress " + report.structure.verdict;
    fmt::print(stderr, "fretwork: {}: {}{} triangles, {} {}, {:.0f} % solid, {}, {:.1f} s\n",
               output == kStream ? "standard output" : output, prefix, report.mesh.report.triangles, pieces,
               pieces == 1 ? "piece" : "pieces", 100.0 * report.pattern.solid_fraction, verdict, report.seconds_total);
}

bool below_standard(const RunReport& report) {
    const MeshReport& mesh = report.mesh.report;
    const bool too_weak =
        report.strength ? !report.strength->faults.empty() : report.structure.max_pa > report.structure.allowable_pa;
    return too_weak || !mesh.closed_manifold() || mesh.self_intersections > 0 ||
           report.pattern.components_after != report.shell.components ||
           (report.print && !report.print->faults.empty()) || (report.slicing && !report.slicing->faults.empty());
}

void put_summary(const CarveOptions& options, const CarveModel& model, const std::vector<RunReport>& reports,
                 Interrupt& interrupt) {
    if (!options.summary.empty()) put(options.summary, summary_json(model, reports, ReportTimes::kInclude), interrupt);
}

int check(const CarveOptions& options, Interrupt& interrupt) {
    const RunControl run = control_of(options.run, interrupt);
    Opened opened = open(options, run.slice(0.0, 0.2));
    open_package(options, opened.model);
    const Settings& settings = opened.request.settings;
    std::vector<RunReport> reports =
        check_targets(opened.model, settings, opened.request.pictures, limits_of(options.run), run.slice(0.2, 1.0));
    for (RunReport& report : reports) {
        const MeshReport& mesh = report.input.mesh;
        if (options.slice.empty()) break;
        std::ranges::copy(printer_warnings(options.slice, mesh.max_mm - mesh.min_mm, settings.fabrication),
                          std::back_inserter(report.warnings));
    }
    if (!options.run.quiet) {
        print_warnings(opened.model, reports);
        for (std::size_t i = 0; i < reports.size(); ++i) print_checked(prefix_of(opened.model, i), reports[i]);
    }
    put_summary(options, opened.model, reports, interrupt);
    return kDone;
}

void put_carved(const CarveOptions& options, const CarvedModel& result, const std::vector<RunReport>& reports,
                const PictureFiles& pictures, const RunControl& run, Interrupt& interrupt) {
    const MeshFormat format = output_format(options.output, options.export_format);
    const MeshBytes carved = carved_bytes(result, options.output, format, run.slice(0.0, 0.6));
    if (!options.preview.empty()) put(options.preview, preview_png(result, run.slice(0.6, 0.9)), interrupt);
    if (!options.report.empty()) put(options.report, report_page(result.model, result.carved, reports), interrupt);
    // With --slice, the slicer has its word first.
    if (options.slice.empty()) put_summary(options, result.model, reports, interrupt);
    if (!options.dependencies.empty()) {
        std::vector<std::string> inputs = files_read(options.pattern, pictures);
        inputs.insert(inputs.begin(), result.model.read_beside.begin(), result.model.read_beside.end());
        if (options.model.path != kStream) inputs.insert(inputs.begin(), options.model.path);
        if (!options.slice.empty()) std::ranges::copy(profile_files(options.slice), std::back_inserter(inputs));
        put(options.dependencies, make_rule(options.output, inputs), interrupt);
    }
    // The result last: whoever sees it sees everything else too.
    if (!carved.materials_path.empty()) put(carved.materials_path, carved.materials, interrupt);
    put(options.output, carved.bytes, interrupt);
    run.checkpoint("write", 1.0);
}

/// Fails before the work is done rather than after it.
void check_slicing(const CarveOptions& options) {
    if (options.slice.empty()) return;
    if (options.output == kStream)
        throw InvalidSetting("--slice needs a file: give -o FILE instead of standard output");
    const MeshFormat format = output_format(options.output, options.export_format);
    if (format != MeshFormat::kThreemf && format != MeshFormat::kStl && format != MeshFormat::kObj &&
        format != MeshFormat::kAmf)
        throw InvalidSetting(
            fmt::format("--slice: slicers read 3MF, STL, OBJ and AMF, and the result is {}", options.output));
    check_target(sliced_path(options.output, options.slice), {options.model.path, options.slice});
}

/// The carved file is in place by now and stays, whatever the slicer says; so does what the run found out.
void slice_result(const CarveOptions& options, const CarveModel& model, std::vector<RunReport>& reports,
                  const RunControl& run, Interrupt& interrupt) {
    if (options.slice.empty()) return;
    run.checkpoint("slice", 0.0);
    try {
        Slicing slicing = slice(options.output, options.slice, run);
        put(slicing.record.output, slicing.bytes, interrupt);
        reports.front().slicing = std::move(slicing.record);
    } catch (...) {
        put_summary(options, model, reports, interrupt);
        throw;
    }
    put_summary(options, model, reports, interrupt);
    run.checkpoint("slice", 1.0);
}

void print_slicing(const RunReport& report) {
    if (!report.slicing) return;
    const SliceRecord& s = *report.slicing;
    const auto told = [](const std::optional<double>& value, const char* unit) {
        return value ? fmt::format(", {:.4g} {}", *value, unit) : std::string();
    };
    fmt::print(stderr, "fretwork: {}: {} layers{}{}\n", s.output, s.layers,
               told(s.seconds ? std::optional(*s.seconds / 3600.0) : std::nullopt, "h"),
               s.filament_g ? told(s.filament_g, "g") : told(s.material_ml, "ml"));
    for (const auto* list : {&s.warnings, &s.faults})
        for (const std::string& text : *list) fmt::print(stderr, "fretwork: warning: {}: {}\n", s.output, text);
}

void check_paint(const CarveOptions& options, const OutputOptions& output) {
    if (output.paint == PaintFormat::kNone) return;
    if (output.colour == OutputColor::kNone)
        throw ConstraintsNotMet("output.paint needs colours, and output.colour = none leaves none; use exemplar");
    if (output_format(options.output, options.export_format) != MeshFormat::kThreemf && !options.run.quiet)
        fmt::print(stderr, "fretwork: warning: {} is not painted: only triangles of a 3MF can be\n", options.output);
}

int carve_command(const CarveOptions& options, Interrupt& interrupt) {
    if (options.check) return check(options, interrupt);
    if (options.output.empty()) throw InvalidSetting("no output: give -o FILE, or --check to carve nothing");
    output_format(options.output, options.export_format);
    check_slicing(options);
    for (const std::string& target :
         {options.output, options.summary, options.report, options.preview, options.dependencies})
        check_target(target, {options.model.path, options.pattern.exemplar, options.pattern.mask, options.source});
    const RunLimits limits = limits_of(options.run);
    const RunControl run = control_of(options.run, interrupt);

    Opened opened = open(options, run.slice(0.0, 0.02));
    const Settings& settings = opened.request.settings;
    const std::unique_ptr<ThreemfEditor> package = open_package(options, opened.model);
    check_paint(options, settings.output);
    std::vector<CarvedTarget> carved =
        carve_targets(opened.model, settings, opened.request.pictures, limits,
                      options.report.empty() ? KeepViews::kNo : KeepViews::kYes, run.slice(0.02, 0.95));

    if (output_format(options.output, options.export_format) == MeshFormat::kThreemf)
        paint_targets(carved, settings.output);
    const std::vector<RunFile> pictures = opened.request.pictures.files(settings.output.source);
    std::vector<RunReport> reports;
    for (const CarvedTarget& target : carved) reports.push_back(target.report);
    const double written = options.slice.empty() ? 1.0 : 0.96;
    put_carved(options, {opened.model, carved, settings, pictures, package.get()}, reports, opened.request.pictures,
               run.slice(0.95, written), interrupt);
    slice_result(options, opened.model, reports, run.slice(written, 1.0), interrupt);
    if (!options.run.quiet) {
        print_warnings(opened.model, reports);
        for (std::size_t i = 0; i < reports.size(); ++i)
            print_done(options.output, prefix_of(opened.model, i), reports[i]);
        print_paint(reports.front().paint);
        print_slicing(reports.front());
    }
    return options.strict && std::ranges::any_of(reports, below_standard) ? kBelowStandard : kDone;
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
    command->add_option("--input-name", options->model.name, "What standard input is called in the result")
        ->type_name("NAME")
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
    command->add_option("--report", options->report, "Write a page of pictures, charts and a 3D view, HTML in one file")
        ->type_name("FILE")
        ->group(files);
    command->add_option("--preview", options->preview, "Draw the result into a PNG")->type_name("FILE")->group(files);
    command
        ->add_option("--objects", options->objects,
                     "Objects of a 3MF to carve, by name, number or part number, with commas between them; all that "
                     "are printed if not given; may be repeated")
        ->type_name("NAME,...")
        ->group(files)
        ->allow_extra_args(false);
    command
        ->add_flag("--ignore-required", options->ignore_required,
                   "Carve a 3MF although it requires an extension that is not known")
        ->group(files);
    command
        ->add_flag("--again", options->again,
                   "IN is a carved 3MF: carve the model that it keeps, as it was; flags change settings")
        ->group(files);
    command->add_option("--source", options->source, "With --again: the model, where IN does not keep it")
        ->type_name("FILE")
        ->group(files);
    command->add_flag("--no-source", options->no_source, "Keep no copy of the model and pictures in a 3MF")
        ->group(files);
    command->add_flag("--no-thumbnail", options->no_thumbnail, "Put no picture of the result into a 3MF")->group(files);
    command->add_option("--paint", options->paint, "Paint the triangles of a 3MF with extruders: prusa, bambu or none")
        ->type_name("SLICER")
        ->group(files);
    command->add_option("--extruders", options->extruders, "Extruders to paint with (4)")->type_name("N")->group(files);
    command
        ->add_option("--slice", options->slice,
                     "Go on to G-code beside OUT, with PrusaSlicer and this .ini, or CuraEngine and this .def.json")
        ->type_name("PROFILE")
        ->group(files);
    command->add_option("-d", options->dependencies, "Write a rule for make that names every file read")
        ->type_name("FILE")
        ->group(files);
    add_run_flags(*command, options->run);
    command->add_flag("--check", options->check, "Say within seconds what would not work; carve nothing")->group("Run");
    command->add_flag("--verify-and-reinforce", options->verify_and_reinforce,
                      fmt::format("Analyse the result in full, strengthen it where weak, and so on until it holds "
                                  "(structure.verify_rounds = {})",
                                  kVerifyRounds));
    command->add_flag("--strict", options->strict, "Exit with 4 where strength or printability falls short")
        ->group("Run");
    command->footer(
        "Examples:\n"
        "  fretwork carve vase.stl --pattern cells -o vase.3mf\n"
        "  fretwork carve bunny.off --size-mm 100 --exemplar leaves.png --thickness-mm 2.4 -o bunny.3mf\n"
        "  fretwork carve project.3mf --objects lid,box --pattern waves -o carved.3mf\n"
        "  fretwork carve carved.3mf --again --seed 2 -o other.3mf\n"
        "  fretwork carve box.scad -D 'width=40' --pattern waves -o box.3mf\n"
        "  openscad -o - --export-format off box.scad | fretwork carve - --input-format off --pattern box.toml -o "
        "box.stl");
    command->callback([options, &chosen] {
        chosen = [options](Interrupt& interrupt) { return carve_command(*options, interrupt); };
    });
}

}  // namespace fretwork::cli
