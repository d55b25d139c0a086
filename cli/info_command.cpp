#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <memory>

#include "cli/carved_facts.h"
#include "cli/command.h"
#include "cli/files.h"
#include "cli/pattern_options.h"
#include "cli/run_options.h"
#include "core/base/error.h"
#include "core/exemplar/exemplar.h"
#include "core/mesh/mesh_report.h"
#include "formats/facts_text.h"
#include "formats/image_file.h"
#include "formats/lower_case.h"
#include "formats/part_facts.h"
#include "formats/threemf_contents.h"
#include "formats/threemf_facts.h"
#include "formats/threemf_objects.h"
#include "formats/threemf_reader.h"

namespace fretwork::cli {
namespace {

struct InfoOptions {
    ModelSource model;
    bool json = false;
    RunOptions run;
};

int print(const Facts& facts, bool as_json) {
    fmt::print("{}", as_json ? facts_json(facts) : facts_lines(facts));
    return kDone;
}

/// Required extensions that are not known are listed rather than refused.
constexpr ThreemfReadOptions kReadAll{.ignore_required = true};

/// What --objects can name.
void add_objects(const ModelBytes& model, Facts& facts, const RunControl& run) {
    std::vector<Facts> objects;
    for (const ThreemfObject& object : read_threemf_objects(model.bytes, model.name, kReadAll, run).objects)
        objects.push_back({{{"name", object.name},
                            {"id", std::int64_t{object.key.id}},
                            {"part_number", object.part_number},
                            {"type", object.type},
                            {"printable", object.printable},
                            {"instances", static_cast<std::int64_t>(object.instances)},
                            {"triangles", static_cast<std::int64_t>(object.mesh.triangles.size())}}});
    facts.add("objects", objects);
}

std::vector<std::string> names_of(const std::vector<FileBeside>& files) {
    std::vector<std::string> names;
    for (const FileBeside& file : files) names.push_back(file.path.string());
    return names;
}

/// The mesh of a 3MF; what else is in it goes to `facts`.
MeshFile package_of(const ModelBytes& model, Facts& facts, const RunControl& run) {
    threemf::Build build(model.bytes, model.name, kReadAll, run);
    add_package_facts(threemf_contents(build, model.bytes, model.name, run), facts);
    return flatten_build(std::move(build), {}, run);
}

int mesh_info(const InfoOptions& options, const RunControl& run) {
    const RunControl reading = run.slice(0.0, 0.3);
    const ModelBytes model = read_bytes(options.model, reading);
    const bool threemf = model.format == MeshFormat::kThreemf;
    Facts package;
    const MeshFile file = threemf ? package_of(model, package, reading) : read_model(model, options.model.cad, reading);
    const MeshReport report = report_mesh(file.mesh, CountSelfIntersections::kYes, run.slice(0.3, 1.0));
    const Vec3 size = report.max_mm - report.min_mm;
    Facts facts;
    facts.add("file", options.model.path);
    facts.add("kind", "mesh");
    facts.add("unit", std::string(length_unit_name(file.unit)));
    facts.add("colors", !file.triangle_colors.empty());
    facts.add("size_mm", std::vector<double>{size[0], size[1], size[2]});
    add_mesh_facts(report, facts);
    std::vector<Facts> parts;
    for (const MeshPart& part : file.parts) parts.push_back(part_facts(part));
    facts.add("parts", parts);
    std::vector<Facts> faces;
    for (const MeshPart& face : file.faces) faces.push_back(face_facts(file.mesh, face));
    if (!faces.empty()) facts.add("faces", faces);
    if (!file.read_beside.empty()) facts.add("read_beside", names_of(file.read_beside));
    if (threemf) {
        add_objects(model, facts, run);
        facts.entries.insert(facts.entries.end(), package.entries.begin(), package.entries.end());
        add_carved_facts(model, facts);
    }
    facts.add("warnings", file.warnings);
    return print(facts, options.json);
}

int picture_info(const InfoOptions& options) {
    const Image picture = read_image(std::filesystem::path(options.model.path));
    Facts facts;
    facts.add("file", options.model.path);
    facts.add("kind", "exemplar");
    facts.add("width_px", std::int64_t{picture.width});
    facts.add("height_px", std::int64_t{picture.height});
    facts.add("has_alpha", picture.has_alpha);
    try {
        const Exemplar exemplar = make_exemplar(picture);
        facts.add("usable", true);
        facts.add("solid_fraction", exemplar.solid_fraction());
        facts.add("tileable", exemplar.tileable);
    } catch (const InvalidInput& unusable) {
        facts.add("usable", false);
        facts.add("reason", unusable.what());
    }
    return print(facts, options.json);
}

int spec_info(const InfoOptions& options) {
    PatternOptions pattern;
    pattern.pattern = options.model.path;
    const Settings settings = settings_of(pattern);
    Facts facts;
    facts.add("file", options.model.path);
    facts.add("kind", "spec");
    add_settings_facts(settings, "", facts);
    return print(facts, options.json);
}

int info_command(const InfoOptions& options, Interrupt& interrupt) {
    const std::string extension = lower_case(std::filesystem::path(options.model.path).extension().string());
    constexpr std::array pictures = {".png", ".jpg", ".jpeg"};
    if (options.model.format.empty() && extension == ".toml") return spec_info(options);
    if (options.model.format.empty() && std::ranges::count(pictures, extension) > 0) return picture_info(options);
    return mesh_info(options, control_of(options.run, interrupt));
}

}  // namespace

void add_info(CLI::App& program, Action& chosen) {
    auto options = std::make_shared<InfoOptions>();
    CLI::App* command =
        program.add_subcommand("info", "Say what a model, picture or spec holds and what is wrong with it");
    command->add_option("file", options->model.path, "A model, a PNG or JPEG, or a spec SPEC.toml; - reads a model")
        ->required()
        ->type_name("FILE");
    command->add_flag("--json", options->json, "As JSON instead of key = value lines");
    command->add_option("--input-format", options->model.format, "Format of a model when the name does not tell")
        ->type_name("FORMAT");
    command->add_option("--input-unit", options->model.unit, "Unit of a model whose file names none (millimeter)")
        ->type_name("UNIT");
    add_run_flags(*command, options->run);
    command->footer("Example:\n  fretwork info bunny.off --json");
    command->callback(
        [options, &chosen] { chosen = [options](Interrupt& interrupt) { return info_command(*options, interrupt); }; });
}

}  // namespace fretwork::cli
