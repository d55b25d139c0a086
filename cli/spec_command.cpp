#include <fmt/format.h>

#include <memory>

#include "cli/command.h"
#include "cli/files.h"
#include "cli/pattern_options.h"
#include "core/base/error.h"
#include "core/pipeline/choose_exemplar.h"
#include "core/pipeline/settings_schema.h"
#include "formats/spec_schema_json.h"
#include "formats/spec_template.h"

namespace fretwork::cli {
namespace {

struct SpecOptions {
    std::string file;
    std::string output = std::string(kStream);
    PatternOptions pattern;
};

int write_text(const SpecOptions& options, const std::string& text, Interrupt& interrupt) {
    check_target(options.output);
    put(options.output, text, interrupt);
    return kDone;
}

int check_spec(const SpecOptions& options) {
    PatternOptions pattern;
    // A path without a slash or the usual ending is still a spec here.
    pattern.pattern = names_spec(options.file) ? options.file : "./" + options.file;
    const Settings settings = settings_of(pattern);
    std::string exemplar = "no exemplar is named";
    if (!settings.exemplar.pattern.empty() || !settings.exemplar.image.empty()) {
        const ChosenExemplar chosen = exemplar_of(settings);
        exemplar = fmt::format("exemplar {}: {} x {} px, {:.0f} % solid", chosen.name, chosen.exemplar.width,
                               chosen.exemplar.height, 100.0 * chosen.exemplar.solid_fraction());
    }
    fmt::print(stderr, "fretwork: {}: fine; {}\n", options.file, exemplar);
    return kDone;
}

void add_output(CLI::App& command, SpecOptions& options) {
    command.add_option("-o,--output", options.output, "Where to write; standard output if not given")
        ->type_name("FILE");
}

}  // namespace

void add_spec(CLI::App& program, Action& chosen) {
    CLI::App* command = program.add_subcommand("spec", "Start, check and describe pattern specs (TOML)");
    command->require_subcommand(1);
    command->footer("Example:\n  fretwork spec init --preset fine -o leaves.toml\n  fretwork spec check leaves.toml");

    auto init = std::make_shared<SpecOptions>();
    CLI::App* init_command = command->add_subcommand("init", "Write a spec with every key explained");
    add_output(*init_command, *init);
    add_pattern_flags(*init_command, init->pattern);
    add_setting_flags(*init_command, init->pattern);
    init_command->callback([init, &chosen] {
        chosen = [init](Interrupt& i) { return write_text(*init, commented_spec(settings_of(init->pattern)), i); };
    });

    auto checked = std::make_shared<SpecOptions>();
    CLI::App* check_command = command->add_subcommand("check", "Say what is wrong with a spec and the files it names");
    check_command->add_option("file", checked->file, "The spec")->required()->type_name("SPEC.toml");
    check_command->callback([checked, &chosen] { chosen = [checked](Interrupt&) { return check_spec(*checked); }; });

    auto schema = std::make_shared<SpecOptions>();
    CLI::App* schema_command = command->add_subcommand("schema", "Write the JSON schema of specs, for editors");
    add_output(*schema_command, *schema);
    schema_command->callback(
        [schema, &chosen] { chosen = [schema](Interrupt& i) { return write_text(*schema, spec_schema_json(), i); }; });

    auto table = std::make_shared<SpecOptions>();
    CLI::App* table_command = command->add_subcommand("table", "Write all keys as Markdown tables");
    add_output(*table_command, *table);
    table_command->callback(
        [table, &chosen] { chosen = [table](Interrupt& i) { return write_text(*table, spec_markdown(), i); }; });
}

}  // namespace fretwork::cli
