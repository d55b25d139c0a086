// The paper's tables 1 and 2 beside ours, and what the project has set itself to reach. Each row is one run of the
// program, file to file, in a process of its own. Markdown on stdout or into a document's section.
// The paper's figures come from hardware that it does not state; compare ratios between rows, and runs on one machine.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "child_process.h"
#include "formats/read_file.h"
#include "formats/scratch_folder.h"
#include "markdown.h"

namespace {

using namespace fretwork;
using namespace fretwork::bench;
using Json = nlohmann::json;
namespace fs = std::filesystem;

struct Job {
    std::string name;
    std::string mesh;      ///< below meshes/
    std::string exemplar;  ///< below exemplars/, or the name of a built-in pattern
    int resolution = 256;
    std::string preset = "default";
};

/// What a job took, from its run report and from the system.
struct Outcome {
    Json report;  ///< null where the job was left out
    double seconds = 0.0;
    std::uint64_t peak_bytes = 0;

    [[nodiscard]] bool ran() const { return !report.is_null(); }
    [[nodiscard]] double stage(const char* name) const { return report["seconds"][name].get<double>(); }
    [[nodiscard]] double before() const { return stage("voxelize") + stage("pyramid"); }
    [[nodiscard]] double first() const { return stage("synthesize"); }
    /// Algorithm 1: voxelising to the end of the loop.
    [[nodiscard]] double algorithm() const { return before() + first() + stage("reinforce"); }
    [[nodiscard]] double synthesis() const { return first() + stage("resynthesis"); }
    [[nodiscard]] double structure() const { return stage("reinforce") - stage("resynthesis"); }
    [[nodiscard]] double gigabytes() const { return static_cast<double>(peak_bytes) * 1e-9; }
};

/// What the paper prints for a job.
struct PaperRow {
    Job job;
    int solid_voxels, iterations;
    double first_s, total_s;                         // Table 1
    std::optional<double> synthesis_s, structure_s;  // Table 2
    std::optional<double> share;                     ///< of the paper's total that is to be reached
};

std::vector<PaperRow> paper_rows() {
    constexpr double third = 1.0 / 3.0, half = 0.5;
    const auto bunny = [](const char* name, const char* exemplar) {
        return Job{std::string("bunny/") + name, "bunny_cgal.off", exemplar, 256, "default"};
    };
    return {
        {bunny("keyboard", "keyboard"), 67651, 4, 1.11, 14.6, 8.6, 4.6, {}},
        {bunny("bluebrown", "c_bluebrown.png"), 84292, 10, 1.11, 34.8, 23.8, 12.1, third},
        {bunny("greencells", "c_greencells.png"), 80917, 3, 1.11, 11.4, 8.3, 4.9, third},
        {bunny("hooks", "hooks"), 55356, 11, 1.11, 40.0, 28.4, 10.5, {}},
        {bunny("waves", "c_waves.png"), 107038, 10, 1.11, 52.4, 37.3, 13.9, third},
        {bunny("animalskin", "c_animalskin.png"), 89110, 24, 1.30, 76.2, 45.5, 26.9, third},
        {{"kitten/hooks", "kitten.off", "hooks", 256, "default"}, 38626, 8, 0.9, 24.3, {}, {}, third},
        {{"skull/hooks", "skull_low.obj", "hooks", 512, "default"}, 241652, 4, 5.9, 40.3, {}, {}, half},
    };
}

struct Options {
    std::string data, document, only;
    bool large = true;
};

class Runner {
  public:
    explicit Runner(const Options& options) : options_(options) {}

    Outcome run(const Job& job) const {
        if (!options_.only.empty() && job.name.find(options_.only) == std::string::npos) return {};
        if (!options_.large && job.resolution > 256) return {};
        const fs::path mesh = fs::path(options_.data) / "meshes" / job.mesh;
        const fs::path summary = scratch_.path() / "summary.json", result = scratch_.path() / "out.3mf";
        const bool picture = job.exemplar.ends_with(".png");
        const fs::path exemplar = fs::path(options_.data) / "exemplars" / job.exemplar;
        if (!fs::exists(mesh) || (picture && !fs::exists(exemplar))) {
            fmt::print(stderr, "{}: left out, its files are not there\n", job.name);
            return {};
        }
        const ChildResult child =
            run_command({FRETWORK_PROGRAM, "carve", mesh, "--up", "y", "--size-mm", "100", "--resolution",
                         std::to_string(job.resolution), "--preset", job.preset, picture ? "--exemplar" : "--pattern",
                         picture ? exemplar.string() : job.exemplar, "-q", "-o", result, "--summary", summary});
        if (child.exit_code != 0)
            throw std::runtime_error(fmt::format("{} ended with exit code {}", job.name, child.exit_code));
        fmt::print(stderr, "{} at {}, {}: {:.1f} s, {:.2f} GB\n", job.name, job.resolution, job.preset, child.seconds,
                   static_cast<double>(child.peak_bytes) * 1e-9);
        return {Json::parse(read_file(summary)), child.seconds, child.peak_bytes};
    }

  private:
    const Options& options_;
    ScratchFolder scratch_;
};

std::string seconds_text(const std::optional<double>& s) {
    return s ? fmt::format("{:.1f}", *s) : "-";
}

std::string paper_table(const std::vector<PaperRow>& rows, const std::vector<Outcome>& outcomes) {
    MarkdownTable table({"model/texture", "grid", "solid voxels", "iterations", "voxelise + pyramid", "t_init",
                         "t_total (Algorithm 1)", "synthesis", "structure", "enlarge", "solidify", "file to file",
                         "GB"});
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const PaperRow& p = rows[i];
        const Outcome& o = outcomes[i];
        if (!o.ran()) continue;
        table.add({p.job.name, std::to_string(p.job.resolution),
                   fmt::format("{} / {}", p.solid_voxels, o.report["pattern"]["solid_voxels"].get<int>()),
                   fmt::format("{} / {}", p.iterations, o.report["iterations"].size()),
                   fmt::format("{:.2f}", o.before()), fmt::format("{:.2f} / {:.2f}", p.first_s, o.first()),
                   fmt::format("{:.1f} / {:.1f}", p.total_s, o.algorithm()),
                   fmt::format("{} / {:.1f}", seconds_text(p.synthesis_s), o.synthesis()),
                   fmt::format("{} / {:.1f}", seconds_text(p.structure_s), o.structure()),
                   fmt::format("{:.1f}", o.stage("enlarge")), fmt::format("{:.1f}", o.stage("solidify")),
                   fmt::format("{:.1f}", o.seconds), fmt::format("{:.2f}", o.gigabytes())});
    }
    return table.text();
}

/// One thing to reach, as a line of the second table.
class TargetTable {
  public:
    TargetTable() : table_({"what", "paper", "to reach", "ours", "reached"}) {}

    void add(const std::string& what, const std::optional<double>& paper, double most, double ours, const char* unit) {
        table_.add({what, paper ? fmt::format("{:.4g} {}", *paper, unit) : "-", fmt::format("{:.3g} {}", most, unit),
                    fmt::format("{:.2f} {}", ours, unit), ours <= most ? "yes" : "**no**"});
    }
    [[nodiscard]] const std::string& text() const { return table_.text(); }

  private:
    MarkdownTable table_;
};

std::string target_table(const Runner& runner, const std::vector<PaperRow>& rows,
                         const std::vector<Outcome>& outcomes) {
    const Job whole{"bunny/cells", "bunny_cgal.off", "cells", 256, "default"};
    Job paper = whole, large = whole;
    paper.preset = "paper";
    large.resolution = 512;
    constexpr double paper_first_s = 1.11;
    TargetTable table;
    if (const Outcome o = runner.run(whole); o.ran()) {
        table.add("bunny 256^3, first synthesis, default preset", paper_first_s, 0.6, o.first(), "s");
        table.add("bunny 256^3, voxelise + pyramid + neighbour lists", {}, 0.3, o.before(), "s");
        table.add("bunny 256^3, solidify", {}, 8.0, o.stage("solidify"), "s");
        table.add("bunny 256^3, solidify (peak of the whole run, an upper bound)", {}, 1.5, o.gigabytes(), "GB");
        table.add("bunny 256^3, whole command, file to file", {}, 30.0, o.seconds, "s");
        table.add("bunny 256^3, whole command, peak memory", {}, 2.0, o.gigabytes(), "GB");
    }
    if (const Outcome o = runner.run(paper); o.ran())
        table.add("bunny 256^3, first synthesis, preset `paper`", paper_first_s, 2.5, o.first(), "s");
    for (std::size_t i = 0; i < rows.size(); ++i)
        if (rows[i].share && outcomes[i].ran())
            table.add(fmt::format("{} {}^3, Algorithm 1", rows[i].job.name, rows[i].job.resolution), rows[i].total_s,
                      *rows[i].share * rows[i].total_s, outcomes[i].algorithm(), "s");
    if (const Outcome o = runner.run(large); o.ran())
        table.add("bunny 512^3, whole command, peak memory", {}, 8.0, o.gigabytes(), "GB");
    return table.text();
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("The paper's tables beside ours");
    app.add_option("data", options.data, "folder with meshes/ and exemplars/")
        ->required()
        ->check(CLI::ExistingDirectory);
    app.add_option("--only", options.only, "jobs whose name holds this, such as bunny/waves");
    app.add_flag("!--no-large", options.large, "leave out runs above 256 voxels");
    app.add_option("--write", options.document, "document whose section 'paper' is replaced");
    CLI11_PARSE(app, argc, argv);
    return publish("paper_tables", options.document, "paper", [&] {
        const Runner runner(options);
        const std::vector<PaperRow> rows = paper_rows();
        std::vector<Outcome> outcomes;
        outcomes.reserve(rows.size());
        for (const PaperRow& row : rows) outcomes.push_back(runner.run(row.job));
        return "Cells with a slash read paper / ours. Seconds of wall clock. Peak memory and *file to file* are those "
               "of "
               "the program's own process, reading and writing included.\n\n" +
               paper_table(rows, outcomes) + "\n" + target_table(runner, rows, outcomes);
    });
}
