#include "cli/scad_model.h"

#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>

#include "cli/child_process.h"
#include "core/base/error.h"
#include "formats/parameter_set_reader.h"
#include "formats/read_file.h"
#include "formats/scad_source.h"

namespace fretwork::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "openscad";

class ScratchFolder {
  public:
    ScratchFolder() {
        std::string name = (fs::temp_directory_path() / "fretwork-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw FileError(name + ": no folder could be made");
        path_ = name;
    }
    ~ScratchFolder() {
        std::error_code none;
        fs::remove_all(path_, none);
    }
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] fs::path operator/(const std::string& name) const { return path_ / name; }

  private:
    fs::path path_;
};

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

std::vector<std::string> command_line(const std::string& path, const ScadOptions& options, const fs::path& result,
                                      const fs::path& rule) {
    std::vector<std::string> line = {kProgram, "-o", result.string(), "--export-format", "off", "-d", rule.string()};
    for (const std::string& define : options.defines) line.insert(line.end(), {"-D", define});
    if (!options.parameter_file.empty())
        line.insert(line.end(), {"-p", options.parameter_file, "-P", options.parameter_set});
    line.push_back(path);
    return line;
}

/// What OpenSCAD says is one message per line; errors come with an exit code of 0 as often as not.
void hear(const std::string& path, const ProcessResult& result, std::vector<std::string>& warnings) {
    std::istringstream lines(result.err + result.out);
    std::string error;
    for (std::string line; std::getline(lines, line);) {
        const bool fault = line.starts_with("ERROR:") || line.find("CGAL error") != line.npos ||
                           line.find("top level object is empty") != line.npos;
        if (fault && error.empty()) error = line;
        if (line.starts_with("WARNING:")) warnings.push_back(fmt::format("{}: OpenSCAD: {}", path, line.substr(9)));
    }
    if (error.empty() && result.exit_code != 0) error = fmt::format("exit code {}", result.exit_code);
    if (!error.empty()) throw InvalidInput(fmt::format("{}: OpenSCAD: {}", path, error));
}

/// Files in a rule for make: words behind the colon, with blanks escaped.
std::vector<std::string> files_in_rule(const std::string& rule) {
    std::vector<std::string> files;
    std::string word;
    const auto close = [&] {
        if (!word.empty()) files.push_back(std::move(word));
        word.clear();
    };
    for (std::size_t at = std::min(rule.find(": "), rule.size()) + 1; at < rule.size(); ++at) {
        const char c = rule[at];
        if (c == '\\' && at + 1 < rule.size() && rule[at + 1] == ' ')
            word += rule[++at];
        else if (c == ' ' || c == '\n' || c == '\t' || c == '\\')
            close();
        else
            word += c;
    }
    close();
    return files;
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

ScadModel render_scad(const std::string& path, const ScadOptions& options, const RunControl& run) {
    const std::string text = read_file(fs::path(path));
    const auto variables = variables_of_scad(text);
    check_parameters(path, options, variables);
    ScadModel scad;
    scad.spec = spec_in_scad(text, path);
    for (const std::string& define : options.defines) {
        const std::string name = define.substr(0, define.find('='));
        if (!variables.contains(name) && !name.starts_with('$'))
            scad.model.warnings.push_back(fmt::format("-D {}: {} assigns no {} itself", define, path, name));
    }
    const ScratchFolder folder;
    const fs::path result = folder / "model.off", rule = folder / "model.d";
    hear(path, run_process(command_line(path, options, result, rule), run), scad.model.warnings);
    std::error_code none;
    if (!fs::exists(result, none)) throw InvalidInput(path + ": OpenSCAD: made no model");
    scad.model.bytes = read_file(result);
    scad.model.format = MeshFormat::kOff;
    scad.model.name = path;
    std::set<std::string> seen = {fs::weakly_canonical(path, none).string()};
    if (fs::exists(rule, none))
        for (const std::string& file : files_in_rule(read_file(rule)))
            if (seen.insert(fs::weakly_canonical(file, none).string()).second)
                scad.model.read_beside.push_back(relative_name(file));
    return scad;
}

}  // namespace fretwork::cli
