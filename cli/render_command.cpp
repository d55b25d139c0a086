#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <memory>
#include <vector>

#include "cli/command.h"
#include "cli/files.h"
#include "cli/render_colors.h"
#include "cli/run_options.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/render/contact_sheet.h"
#include "formats/png_writer.h"

namespace fretwork::cli {
namespace {

struct RenderOptions {
    ModelSource model;
    std::string output;
    std::string size = "1200";
    RenderSettings settings;
    int views = 1;
    bool no_colors = false;
    std::string color = "pattern";
    RunOptions run;
};

int pixels(std::string_view text, const std::string& whole) {
    int value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size())
        throw InvalidSetting(fmt::format("--size {}: expected a number of pixels, or WIDTHxHEIGHT", whole));
    return value;
}

void set_size(const std::string& size, RenderSettings& settings) {
    const auto cross = size.find('x');
    settings.width = pixels(std::string_view(size).substr(0, cross), size);
    settings.height =
        cross == std::string::npos ? settings.width : pixels(std::string_view(size).substr(cross + 1), size);
}

Image picture_of(const MeshFile& file, const RenderOptions& options, const RenderSettings& settings,
                 const RunControl& run) {
    const std::vector<Rgb8> colors = options.no_colors ? std::vector<Rgb8>{} : file.triangle_colors;
    if (options.views == 1) return render(file.mesh, colors, settings, run);
    std::vector<double> azimuths;
    std::vector<Image> pictures;
    for (int i = 0; i < options.views; ++i) azimuths.push_back(settings.azimuth_deg + 360.0 * i / options.views);
    for (std::size_t i = 0; i < azimuths.size(); ++i) {
        RenderSettings view = settings;
        view.azimuth_deg = azimuths[i];
        const double count = static_cast<double>(azimuths.size());
        pictures.push_back(render(file.mesh, colors, view,
                                  run.slice(static_cast<double>(i) / count, static_cast<double>(i + 1) / count)));
    }
    return contact_sheet(pictures, static_cast<int>(std::ceil(std::sqrt(options.views))));
}

/// The model with the colours that were asked for.
MeshFile colored_model(const RenderOptions& options, const RunControl& run) {
    const RenderColor color = render_color_named(options.color);
    if (color == RenderColor::kPattern) return read_model(options.model, run);
    if (color == RenderColor::kSolid) {
        MeshFile file = read_model(options.model, run);
        file.triangle_colors.clear();
        return file;
    }
    const ModelBytes model = read_bytes(options.model, run);
    if (model.format != MeshFormat::kThreemf)
        throw InvalidInput(fmt::format("--colour {}: found {}, expected a carved 3MF", options.color, model.name));
    VolumetricFile file = read_threemf_with_volumes(model.bytes, model.name, run, {model.ignore_required});
    file.mesh.triangle_colors = render_colors(file, color, model.name);
    return std::move(file.mesh);
}

int render_command(const RenderOptions& options, Interrupt& interrupt) {
    check_target(options.output, {options.model.path});
    RenderSettings settings = options.settings;
    set_size(options.size, settings);
    const ThreadLimit threads(options.run.threads);
    const RunControl run = control_of(options.run, interrupt);
    const MeshFile file = colored_model(options, run.slice(0.0, 0.1));
    if (!options.run.quiet) print_warnings(file);
    const Image picture = picture_of(file, options, settings, run.slice(0.1, 0.95));
    put(options.output, write_png(picture), interrupt);
    run.checkpoint("write", 1.0);
    return kDone;
}

}  // namespace

void add_render(CLI::App& program, Action& chosen) {
    auto options = std::make_shared<RenderOptions>();
    CLI::App* command = program.add_subcommand("render", "Draw a shaded picture of a model; no display needed");
    command->add_option("model", options->model.path, std::string(kReadable) + "; - reads standard input")
        ->required()
        ->type_name("FILE");
    command->add_option("-o,--output", options->output, "The picture; - writes standard output")
        ->required()
        ->type_name("PNG");
    command->add_option("--size", options->size, "Pixels per side, or WIDTHxHEIGHT (1200)")->type_name("PX");
    command
        ->add_option("--azimuth", options->settings.azimuth_deg, "Degrees around the vertical; 0 looks along +y (30)")
        ->type_name("DEG");
    command->add_option("--elevation", options->settings.elevation_deg, "Degrees above the horizon (20)")
        ->type_name("DEG")
        ->check(CLI::Range(-90.0, 90.0));
    command->add_option("--zoom", options->settings.zoom, "1 shows the whole model, 2 half of its width")
        ->type_name("X")
        ->check(CLI::Range(0.01, 1000.0));
    command->add_option("--views", options->views, "Views from all around on one sheet")
        ->type_name("N")
        ->check(CLI::Range(1, 36));
    command
        ->add_option("--colour,--color", options->color,
                     "pattern, or of a carved 3MF what its voxel data say: stress, bridges, labels; solid is one "
                     "material (pattern)")
        ->type_name("WHAT");
    command->add_flag("--no-colors", options->no_colors, "One material instead of the model's colours");
    add_ignore_required_flag(*command, options->model);
    command->add_option("--input-format", options->model.format, "Format of FILE when the name does not tell")
        ->type_name("FORMAT");
    add_run_flags(*command, options->run);
    command->footer("Example:\n  fretwork render vase.3mf -o vase.png --azimuth 45 --views 4 --size 600");
    command->callback([options, &chosen] {
        chosen = [options](Interrupt& interrupt) { return render_command(*options, interrupt); };
    });
}

}  // namespace fretwork::cli
