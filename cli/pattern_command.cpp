#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "cli/files.h"
#include "cli/pattern_options.h"
#include "cli/run_options.h"
#include "cli/vase.h"
#include "core/base/error.h"
#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/pipeline/carve.h"
#include "core/render/render.h"
#include "formats/facts_text.h"
#include "formats/png_writer.h"

namespace fretwork::cli {
namespace {

struct PreviewOptions {
    ModelSource model;
    std::string output;
    PatternOptions pattern;
    RunOptions run;
};

struct ShowOptions {
    std::string name, picture, mask;
    bool json = false;
};

Facts facts_of(const BuiltinPattern& p) {
    Facts facts;
    facts.add("name", std::string(p.name));
    facts.add("description", std::string(p.description));
    facts.add("tileable", p.tileable);
    facts.add("directed", p.anisotropic);
    facts.add("connected", p.connected);
    facts.add("width_mm", p.width_mm);
    return facts;
}

int list_patterns(bool json) {
    std::vector<Facts> list;
    for (const BuiltinPattern& p : builtin_patterns()) {
        if (!json) fmt::print("{:<12} {}\n", p.name, p.description);
        list.push_back(facts_of(p));
    }
    if (json) fmt::print("{}", facts_json(list));
    return kDone;
}

int show_pattern(const ShowOptions& options, Interrupt& interrupt) {
    const BuiltinPattern& p = find_builtin(options.name);
    check_target(options.picture);
    check_target(options.mask);
    if (!options.picture.empty() || !options.mask.empty()) {
        const PatternPictures pictures = draw_builtin(p.name);
        if (!options.picture.empty()) put(options.picture, write_png(pictures.color), interrupt);
        if (!options.mask.empty()) put(options.mask, write_png(pictures.mask), interrupt);
    }
    if (options.picture == kStream || options.mask == kStream) return kDone;
    fmt::print("{}", options.json ? facts_json(facts_of(p)) : facts_lines(facts_of(p)));
    return kDone;
}

int preview_pattern(PreviewOptions options, Interrupt& interrupt) {
    check_target(options.output, {options.model.path, options.pattern.exemplar});
    if (options.pattern.preset.empty()) options.pattern.preset = "draft";
    Settings settings = settings_of(options.pattern);
    if (options.model.path.empty()) settings.keep.push_back(vase_lip());
    const RunControl run = control_of(options.run, interrupt);
    ChosenExemplar chosen = exemplar_of(settings);
    CarveInput input;
    input.model_name = options.model.path.empty() ? "the vase" : options.model.path;
    input.mesh = options.model.path.empty() ? make_vase() : read_model(options.model, run.slice(0.0, 0.02)).mesh;
    input.exemplar = std::move(chosen.exemplar);
    input.exemplar_width_mm = chosen.natural_width_mm;
    input.exemplar_name = chosen.name;
    const CarveResult result = carve(input, settings, limits_of(options.run), run.slice(0.02, 0.9));
    const Image picture = render(result.carved.mesh, result.carved.triangle_colors, {}, run.slice(0.9, 0.99));
    put(options.output, write_png(picture), interrupt);
    run.checkpoint("write", 1.0);
    return kDone;
}

void add_preview(CLI::App& command, Action& chosen) {
    auto options = std::make_shared<PreviewOptions>();
    CLI::App* preview = command.add_subcommand("preview", "Carve a draft and draw it");
    preview->add_option("pattern", options->pattern.pattern, "A built-in pattern, or a spec SPEC.toml")
        ->required()
        ->type_name("NAME|SPEC");
    preview->add_option("-m,--model", options->model.path, "Show it on this model instead of a vase")
        ->type_name("FILE");
    preview->add_option("-o,--output", options->output, "The picture; - writes standard output")
        ->required()
        ->type_name("PNG");
    add_setting_flags(*preview, options->pattern);
    add_run_flags(*preview, options->run);
    preview->footer("Example:\n  fretwork pattern preview cells -m bunny.off --size-mm 100 -o cells.png");
    preview->callback([options, &chosen] {
        chosen = [options](Interrupt& interrupt) { return preview_pattern(*options, interrupt); };
    });
}

}  // namespace

void add_pattern(CLI::App& program, Action& chosen) {
    CLI::App* command = program.add_subcommand("pattern", "List, show and preview patterns");
    command->require_subcommand(1);
    command->footer("Example:\n  fretwork pattern list\n  fretwork pattern preview hooks -o hooks.png");

    auto json = std::make_shared<bool>(false);
    CLI::App* list = command->add_subcommand("list", "Name the built-in patterns");
    list->add_flag("--json", *json, "As JSON");
    list->callback([json, &chosen] { chosen = [json](Interrupt&) { return list_patterns(*json); }; });

    auto options = std::make_shared<ShowOptions>();
    CLI::App* show = command->add_subcommand("show", "Describe a built-in pattern, or write its pictures");
    show->add_option("name", options->name, "The pattern")->required()->type_name("NAME");
    show->add_option("-o,--output", options->picture, "Write its colours")->type_name("PNG");
    show->add_option("--mask", options->mask, "Write what is solid, as light")->type_name("PNG");
    show->add_flag("--json", options->json, "As JSON");
    show->callback(
        [options, &chosen] { chosen = [options](Interrupt& interrupt) { return show_pattern(*options, interrupt); }; });

    add_preview(*command, chosen);
}

}  // namespace fretwork::cli
