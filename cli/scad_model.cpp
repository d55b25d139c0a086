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

/// Variables of the file and of what it includes, however deep; what it only uses keeps its own values.
/// \param read  every file that OpenSCAD has read
std::set<std::string, std::less<>> variables_with_included(const std::string& text, const std::set<std::string>& read) {
    auto variables = variables_of_scad(text);
    std::vector<std::string> texts = {text};
    std::set<std::string> seen;
    for (std::size_t i = 0; i < texts.size(); ++i)
        for (const std::string& included : included_by_scad(texts[i]))
            for (const std::string& file : read) {
                if (fs::path(file).filename() != fs::path(included).filename() || !seen.insert(file).second) continue;
                texts.push_back(read_file(fs::path(file)));
                variables.merge(variables_of_scad(texts.back()));
            }
    return variables;
}

/// OpenSCAD sets a variable that nothing reads without a word.
void check_defines(const std::string& name, const ScadOptions& options,
                   const std::set<std::string, std::less<>>& variables) {
    for (const std::string& define : options.defines) {
        const std::string variable = define.substr(0, define.find('='));
        if (!variables.contains(variable) && !variable.starts_with('$'))
            throw InvalidSetting(
                fmt::format("-D {}: neither {} nor what it includes assigns {}; a key of the spec has a dot", define,
                            name, variable));
    }
}

std::string relative_name(const std::string& file) {
    std::error_code none;
    const fs::path near = fs::proximate(file, none);
    return none ? file : near.string();
}

}  // namespace

bool is_scad(const ModelSource& source) {
    return source.format.empty() ? source.path.ends_with(".scad") : source.format == "scad";
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
    const std::string text = path == kStream ? read_stdin() : read_file(fs::path(path));
    const OpenScad program(path, text, options);
    const std::string name = program.name();
    check_parameters(name, options, variables_of_scad(text));
    ScadModel scad;
    scad.spec = spec_in_scad(text, name);
    ScadRender body = program.render("body", run);
    if (!body.error.empty()) throw InvalidInput(fmt::format("{}: OpenSCAD: {}", name, body.error));
    check_defines(name, options, variables_with_included(text, body.files));
    for (const std::string& line : body.lines)
        if (line.starts_with("WARNING:"))
            scad.model.warnings.push_back(fmt::format("{}: OpenSCAD: {}", name, line.substr(9)));
    if (marks == ScadMarks::kRender) scad.marks = render_marks(program, marks_in(body.lines, name), body.files, run);
    scad.model.bytes = std::move(body.off);
    scad.model.format = MeshFormat::kOff;
    scad.model.name = name;
    std::error_code none;
    const std::string itself = fs::weakly_canonical(path, none).string();
    for (const std::string& file : body.files)
        if (file != itself) scad.model.read_beside.push_back(relative_name(file));
    return scad;
}

}  // namespace fretwork::cli
