#include "cli/openscad.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>

#include "cli/child_process.h"
#include "cli/files.h"
#include "cli/fretwork_scad.h"
#include "formats/read_file.h"

namespace fretwork::cli {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "openscad";
constexpr const char* kEmpty = "top level object is empty";
constexpr const char* kNoFile = "WARNING: Can't open ";  ///< a library, an included file or an import

/// Where OpenSCAD looks for libraries: what the user has set, then ours.
std::string library_path(const fs::path& ours) {
    const char* set = std::getenv("OPENSCADPATH");
    return fmt::format("OPENSCADPATH={}{}{}", set == nullptr ? "" : set, set == nullptr ? "" : ":", ours.string());
}

/// Messages are one per line; errors come with an exit code of 0 as often as not.
void hear(const ProcessResult& result, ScadRender& render) {
    std::istringstream lines(result.err + result.out);
    for (std::string line; std::getline(lines, line);) {
        const bool fault = line.starts_with("ERROR:") || line.starts_with(kNoFile) ||
                           line.find("CGAL error") != line.npos || line.find(kEmpty) != line.npos;
        if (fault && render.error.empty()) render.error = line;
        render.lines.push_back(std::move(line));
    }
    if (render.error.empty() && result.exit_code != 0) render.error = fmt::format("exit code {}", result.exit_code);
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

}  // namespace

bool ScadRender::draws_nothing() const {
    return error.find(kEmpty) != error.npos;
}

OpenScad::OpenScad(std::string path, const std::string& text, ScadOptions options)
    : path_(std::move(path)), options_(std::move(options)) {
    std::ofstream(folder_ / "fretwork.scad") << kFretworkScad;
    if (path_ != kStream) return;
    standard_input_ = (folder_ / "input.scad").string();
    std::ofstream(standard_input_) << text;
}

std::string OpenScad::name() const {
    return path_ == kStream ? kStreamName : path_;
}

ScadRender OpenScad::render(const std::string& wanted, const RunControl& run) const {
    const fs::path result = folder_ / "model.off", rule = folder_ / "model.d";
    std::error_code none;
    fs::remove(result, none);
    fs::remove(rule, none);
    std::vector<std::string> line = {kProgram, "-o", result.string(), "--export-format", "off", "-d", rule.string()};
    line.insert(line.end(), {"-D", fmt::format("$fretwork=\"{}\"", wanted)});
    for (const std::string& define : options_.defines) line.insert(line.end(), {"-D", define});
    if (!options_.parameter_file.empty())
        line.insert(line.end(), {"-p", options_.parameter_file, "-P", options_.parameter_set});
    line.push_back(path_);
    ScadRender render;
    hear(run_process(line, run, {library_path(folder_.path())}, standard_input_), render);
    if (fs::exists(result, none)) render.off = read_file(result);
    if (render.off.empty() && render.error.empty()) render.error = "made no model";
    if (!fs::exists(rule, none)) return render;
    for (const std::string& file : files_in_rule(read_file(rule))) {
        const fs::path resolved = fs::weakly_canonical(file, none);
        if (resolved.parent_path() != folder_.path()) render.files.insert(resolved.string());
    }
    return render;
}

}  // namespace fretwork::cli
