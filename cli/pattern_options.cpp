#include "cli/pattern_options.h"

#include <fmt/format.h>

#include <filesystem>
#include <iterator>

#include "core/base/error.h"
#include "core/pipeline/settings_schema.h"
#include "formats/image_file.h"
#include "formats/parameter_set_reader.h"
#include "formats/spec_toml_reader.h"

namespace fretwork::cli {
namespace {

namespace fs = std::filesystem;

// Paths in a spec are meant from where the spec lies.
void anchor_paths(const fs::path& spec, std::vector<SettingAssignment>& assignments) {
    for (SettingAssignment& assignment : assignments) {
        if (assignment.key != "exemplar.image" && assignment.key != "exemplar.mask") continue;
        if (auto* text = std::get_if<std::string>(&assignment.value))
            if (!text->empty() && fs::path(*text).is_relative()) *text = (spec.parent_path() / *text).string();
    }
}

// OpenSCAD stores every parameter as text; the key says what it should be.
void add_parameter_set(const PatternOptions& options, SpecDocument& document) {
    if (options.parameter_file.empty() != options.parameter_set.empty())
        throw InvalidSetting("-p FILE and -P SET go together: the file of parameter sets, and the set to take");
    if (options.parameter_file.empty()) return;
    for (const SettingAssignment& entry : read_parameter_set(fs::path(options.parameter_file), options.parameter_set)) {
        if (options.parameters_of_model && entry.key.find('.') == std::string::npos) continue;
        const auto* text = std::get_if<std::string>(&entry.value);
        document.assignments.push_back(text ? parse_setting(entry.key, *text, entry.place) : entry);
    }
}

void add_source(const PatternOptions& options, SpecDocument& document) {
    const auto set = [&](const char* key, const std::string& value, const char* flag) {
        document.assignments.push_back({key, value, flag});
    };
    if (!options.pattern.empty() && !names_spec(options.pattern)) {
        if (!options.exemplar.empty())
            throw InvalidSetting("--pattern NAME and --exemplar exclude each other; leave one out");
        set("exemplar.pattern", options.pattern, "--pattern");
    }
    if (!options.exemplar.empty()) {
        set("exemplar.pattern", "", "--exemplar");
        set("exemplar.image", options.exemplar, "--exemplar");
    }
    if (!options.mask.empty()) set("exemplar.mask", options.mask, "--mask");
}

void add_named_flags(const PatternOptions& options, SpecDocument& document) {
    const auto set = [&](const char* key, const auto& value, const char* flag) {
        if (value) document.assignments.push_back({key, SettingValue(*value), flag});
    };
    if (options.seed) {
        if (*options.seed > static_cast<std::uint64_t>(setting_info("synthesis.seed").range->max))
            throw InvalidSetting(
                fmt::format("--seed {}: expected {}", *options.seed, describe_range(setting_info("synthesis.seed"))));
        document.assignments.push_back({"synthesis.seed", static_cast<std::int64_t>(*options.seed), "--seed"});
    }
    set("input.size_mm", options.size_mm, "--size-mm");
    set("shell.thickness_mm", options.thickness_mm, "--thickness-mm");
    set("exemplar.width_mm", options.width_mm, "--width-mm");
    if (options.resolution)
        document.assignments.push_back({"shell.resolution", std::int64_t{*options.resolution}, "--resolution"});
    if (!options.up.empty()) document.assignments.push_back({"input.up", options.up, "--up"});
    if (!options.preset.empty()) document.assignments.push_back({"synthesis.preset", options.preset, "--preset"});
}

ChosenExemplar make_exemplar(const ExemplarOptions& options, PictureFiles& pictures) {
    if (!options.pattern.empty()) return builtin_exemplar(options);
    if (options.image.empty())
        throw InvalidSetting(
            "no pattern: give --pattern NAME (fretwork pattern list), --pattern SPEC.toml or --exemplar IMAGE");
    exemplar_settings(options);  // complains about contradictions before anything is read
    const Image picture = read_image(pictures.bytes_of(options.image), options.image);
    if (options.mask.empty()) return picture_exemplar(options, picture, nullptr);
    const Image mask = read_image(pictures.bytes_of(options.mask), options.mask);
    return picture_exemplar(options, picture, &mask);
}

}  // namespace

void add_setting_flags(CLI::App& command, PatternOptions& o) {
    const char* group = "Settings";
    command
        .add_option("-D,--set", o.assignments,
                    "Set any key of a spec, as in -D shell.thickness_mm=2.5; may be repeated")
        ->type_name("KEY=VALUE")
        ->group(group)
        ->allow_extra_args(false);
    command.add_option("-p", o.parameter_file, "OpenSCAD Customizer file that holds named sets of keys")
        ->type_name("FILE")
        ->group(group);
    command.add_option("-P", o.parameter_set, "The set of -p to take")->type_name("SET")->group(group);
    command.add_option("--preset", o.preset, "Starting values: draft, default, fine or paper")
        ->type_name("NAME")
        ->group(group);
    command.add_option("--seed", o.seed, "Another number gives another arrangement of the same pattern")
        ->type_name("N")
        ->group(group);
    command
        .add_option("--size-mm", o.size_mm, "Scale the model so that its longest side is this; for files without units")
        ->type_name("MM")
        ->group(group);
    command.add_option("--up", o.up, "Axis of the model that points up: x, y, z, -x, -y or -z; the model is turned")
        ->type_name("AXIS")
        ->group(group);
    command.add_option("--thickness-mm", o.thickness_mm, "Thickness of the carved wall")->type_name("MM")->group(group);
    command.add_option("--width-mm", o.width_mm, "Width of one repeat of the pattern on the surface")
        ->type_name("MM")
        ->group(group);
    command.add_option("--resolution", o.resolution, "Voxels along the longest side (256)")
        ->type_name("N")
        ->group(group);
}

void add_pattern_flags(CLI::App& command, PatternOptions& o) {
    const char* group = "Pattern";
    command
        .add_option("--pattern", o.pattern, "A built-in pattern by name (fretwork pattern list), or a spec SPEC.toml")
        ->type_name("NAME|SPEC")
        ->group(group);
    command.add_option("--exemplar", o.exemplar, "A picture of the pattern, PNG or JPEG; dark is solid unless masked")
        ->type_name("IMAGE")
        ->group(group);
    command.add_option("--mask", o.mask, "A picture whose light parts are solid; beside --exemplar")
        ->type_name("IMAGE")
        ->group(group);
}

bool names_spec(const std::string& pattern) {
    return pattern.ends_with(".toml") || pattern.find('/') != std::string::npos;
}

Settings settings_of(const PatternOptions& options) {
    return settings_of(options, spec_of(options));
}

SpecDocument spec_of(const PatternOptions& options) {
    if (!names_spec(options.pattern)) return {};
    return anchored(options.pattern, read_spec_toml(fs::path(options.pattern)));
}

SpecDocument anchored(const std::string& file, SpecDocument document) {
    anchor_paths(file, document.assignments);
    for (SettingTable& table : document.tables) anchor_paths(file, table.entries);
    return document;
}

Settings settings_of(const PatternOptions& options, SpecDocument document) {
    add_source(options, document);
    add_parameter_set(options, document);
    for (const std::string& assignment : options.assignments)
        document.assignments.push_back(parse_assignment(assignment, "-D"));
    add_named_flags(options, document);
    return settings_from(document);
}

ChosenExemplar exemplar_of(const Settings& settings) {
    PictureFiles pictures;
    return exemplar_of(settings, pictures);
}

const ChosenExemplar& exemplar_of(const Settings& settings, PictureFiles& pictures) {
    const ExemplarOptions& options = settings.exemplar;
    return pictures.exemplar(options, [&] { return make_exemplar(options, pictures); });
}

std::vector<std::string> files_read(const PatternOptions& options, const PictureFiles& pictures) {
    std::vector<std::string> files;
    if (names_spec(options.pattern)) files.push_back(options.pattern);
    if (!options.parameter_file.empty()) files.push_back(options.parameter_file);
    for (const RunFile& picture : pictures.files(false)) files.push_back(picture.path);
    return files;
}

}  // namespace fretwork::cli
