#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "cli/files.h"
#include "cli/run_options.h"
#include "core/base/error.h"

namespace fretwork::cli {
namespace {

struct ConvertOptions {
    ModelSource model;
    std::string output, export_format;
    double scale = 1.0;
    RunOptions run;
};

int convert_command(const ConvertOptions& options, Interrupt& interrupt) {
    const MeshFormat format = output_format(options.output, options.export_format);
    check_target(options.output, {options.model.path});
    const RunControl run = control_of(options.run, interrupt);
    const ModelBytes model = read_bytes(options.model);
    MeshFile file = read_model(model, options.model.cad, run.slice(0.0, 0.6));
    if (!options.run.quiet) print_warnings(file);
    for (Vec3& p : file.mesh.positions_mm) p *= options.scale;
    const MeshBytes result = mesh_bytes(options.output, {file.mesh, file.triangle_colors, title_of(model)}, format);
    if (!result.materials_path.empty()) put(result.materials_path, result.materials, interrupt);
    put(options.output, result.bytes, interrupt);
    run.checkpoint("write", 1.0);
    return kDone;
}

}  // namespace

void add_convert(CLI::App& program, Action& chosen) {
    auto options = std::make_shared<ConvertOptions>();
    CLI::App* command = program.add_subcommand("convert", "Turn a model into another format");
    command->add_option("in", options->model.path, std::string(kReadable) + "; - reads standard input")
        ->required()
        ->type_name("IN");
    command->add_option("out", options->output, std::string(kWritable) + "; - writes standard output")
        ->required()
        ->type_name("OUT");
    add_ignore_required_flag(*command, options->model);
    command->add_option("--input-format", options->model.format, "Format of IN when the name does not tell")
        ->type_name("FORMAT");
    command->add_option("--input-name", options->model.name, "What standard input is called in the result")
        ->type_name("NAME");
    command->add_option("--input-unit", options->model.unit, "Unit of a model whose file names none (millimeter)")
        ->type_name("UNIT");
    command->add_option("--export-format", options->export_format, "Format of OUT when the name does not tell")
        ->type_name("FORMAT");
    command->add_option("--scale", options->scale, "Factor on all coordinates")
        ->type_name("X")
        ->check(CLI::PositiveNumber);
    add_run_flags(*command, options->run);
    command->footer("Example:\n  fretwork convert part.stl part.3mf --input-unit inch");
    command->callback([options, &chosen] {
        chosen = [options](Interrupt& interrupt) { return convert_command(*options, interrupt); };
    });
}

}  // namespace fretwork::cli
