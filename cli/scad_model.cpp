#include "cli/scad_model.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>

#include "cli/scad_marks.h"
#include "core/base/error.h"
#include "formats/parameter_set_reader.h"
#include "formats/read_file.h"
#include "formats/scad_source.h"

namespace fretwork::cli {
namespace {

namespace fs = std::filesystem;

/// A parameter that OpenSCAD would drop without a word is an error here.
void check_parameters(const std::string& path, const ScadOptions& options,
                      const std::set<std::string, std::less<>>& variables) {
    if (options.parameter_file.empty()) return;
    for (const SettingAssignment& entry : read_parameter_set(fs::path(options.parameter_file), options.parameter_set))
        if (entry.key.find('.') == std::string::npos && !variables.contains(entry.key))
            throw InvalidSetting(
                fmt::format("{}: set {}: found {}, which is neither a key of a spec nor assigned in {}",
                            options.parameter_file, options.parameter_set, entry.key, path));
}

/// Names of variables set with -D that the file itself does not assign.
std::vector<std::string> unknown_defines(const std::string& path, const ScadOptions& options,
                                         const std::set<std::string, std::less<>>& variables) {
    std::vector<std::string> warnings;
    for (const std::string& define : options.defines) {
        const std::string name = define.substr(0, define.find('='));
        if (!variables.contains(name) && !name.starts_with('$'))
            warnings.push_back(fmt::format("-D {}: {} assigns no {} itself", define, path, name));
    }
    return warnings;
}

std::string relative_name(const std::string& file) {
    std::error_code none;
    const fs::path near = fs::proximate(file, none);
    return none ? file : near.string();
}

}  // namespace

bool is_scad(const std::string& path) {
    return path.ends_with(".scad");
}

ScadOptions take_scad_options(PatternOptions& pattern) {
    ScadOptions options{{}, pattern.parameter_file, pattern.parameter_set};
    std::vector<std::string> ours;
    for (std::string& assignment : pattern.assignments) {
        const std::string_view key = std::string_view(assignment).substr(0, assignment.find('='));
        (key.find('.') == key.npos ? options.defines : ours).push_back(std::move(assignment));
    }
    pattern.assignments = std::move(ours);
    return options;
}

ScadModel render_scad(const std::string& path, const ScadOptions& options, ScadMarks marks, const RunControl& run) {
    const std::string text = read_file(fs::path(path));
    const auto variables = variables_of_scad(text);
    check_parameters(path, options, variables);
    ScadModel scad;
    scad.spec = spec_in_scad(text, path);
    scad.model.warnings = unknown_defines(path, options, variables);

    const OpenScad program(path, options);
    ScadRender body = program.render("body", run);
    if (!body.error.empty()) throw InvalidInput(fmt::format("{}: OpenSCAD: {}", path, body.error));
    for (const std::string& line : body.lines)
        if (line.starts_with("WARNING:"))
            scad.model.warnings.push_back(fmt::format("{}: OpenSCAD: {}", path, line.substr(9)));
    if (marks == ScadMarks::kRender) scad.marks = render_marks(program, marks_in(body.lines, path), body.files, run);
    scad.model.bytes = std::move(body.off);
    scad.model.format = MeshFormat::kOff;
    scad.model.name = path;
    std::error_code none;
    const std::string itself = fs::weakly_canonical(path, none).string();
    for (const std::string& file : body.files)
        if (file != itself) scad.model.read_beside.push_back(relative_name(file));
    return scad;
}

}  // namespace fretwork::cli
