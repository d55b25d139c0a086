// Seconds and peak memory of every stage against the number of surface voxels, for one model at growing resolution.
// Markdown on stdout or into a document's section; plots as SVG.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "child_process.h"
#include "core/pipeline/carve.h"
#include "core/pipeline/choose_exemplar.h"
#include "core/pipeline/memory_use.h"
#include "formats/atomic_write.h"
#include "formats/mesh_file.h"
#include "markdown.h"
#include "support/make_meshes.h"
#include "svg_plot.h"

namespace {

using namespace fretwork;
using namespace fretwork::bench;
using Json = nlohmann::json;
namespace fs = std::filesystem;

constexpr std::array kStages = {"repair",  "voxelize", "pyramid", "synthesize",  "reinforce",
                                "enlarge", "solidify", "verify",  "printability"};
/// Fixed costs are left out of the fits.
constexpr int kLeastFittedResolution = 128;

struct Options {
    std::string data, pattern = "cells", document, images;
    int largest = 512;
};

struct GrowthRow {
    int resolution = 0;
    double surface_voxels = 0.0;
    std::vector<double> seconds, bytes;  ///< by stage
    double seconds_total = 0.0, bytes_peak = 0.0;
};

/// Notes the peak of memory at the end of each stage, as the progress reports tell of them.
class StageMemory {
  public:
    void hear(std::string_view stage) {
        const auto found = std::ranges::find(kStages, stage);
        if (found == kStages.end() || stage == current_) return;
        note();
        current_ = *found;
    }
    void note() {
        if (!current_.empty()) bytes_[current_] = peak_memory_bytes();
        restart_peak_memory();
    }
    [[nodiscard]] const Json& bytes() const { return bytes_; }

  private:
    std::string current_;
    Json bytes_ = Json::object();
};

CarveInput carve_input(const Options& options, Settings& settings) {
    CarveInput input;
    const fs::path bunny = fs::path(options.data) / "meshes" / "bunny_cgal.off";
    if (!options.data.empty() && fs::exists(bunny)) {
        input.mesh = read_mesh(bunny).mesh;
        input.model_name = "bunny";
        settings.input.up = UpAxis::kY;
    } else {
        input.mesh = testing::make_vase(100, 192, 160);
        input.model_name = "vase";
    }
    settings.input.size_mm = 100.0;
    settings.exemplar.pattern = options.pattern;
    ChosenExemplar chosen = builtin_exemplar(settings.exemplar);
    input.exemplar = std::move(chosen.exemplar);
    input.exemplar_name = chosen.name;
    input.exemplar_width_mm = chosen.natural_width_mm;
    return input;
}

/// In the child: one whole run.
std::string run_at(const Options& options, int resolution) {
    Settings settings;
    const CarveInput input = carve_input(options, settings);
    settings.shell.resolution = resolution;
    StageMemory memory;
    const RunControl run([&](std::string_view stage, double) { memory.hear(stage); });
    const RunReport report = carve(input, settings, {}, run).report;
    memory.note();
    Json json{{"voxels", report.shell.surface_voxels}, {"total", report.seconds_total}, {"bytes", memory.bytes()}};
    for (const StageSeconds& s : report.seconds) json["seconds"][s.stage] = s.seconds;
    return json.dump();
}

GrowthRow measure(const Options& options, int resolution) {
    const ChildResult child = run_in_child([&] { return run_at(options, resolution); });
    if (child.exit_code != 0) throw std::runtime_error(fmt::format("the run at {} voxels failed", resolution));
    const Json json = Json::parse(child.output);
    GrowthRow row;
    row.resolution = resolution;
    row.surface_voxels = json["voxels"];
    row.seconds_total = json["total"];
    for (const char* stage : kStages) {
        row.seconds.push_back(json["seconds"].value(stage, 0.0));
        row.bytes.push_back(json["bytes"].value(stage, 0.0));
        row.bytes_peak = std::max(row.bytes_peak, row.bytes.back());
    }
    return row;
}

/// A curve per stage and one for the whole.
template <class OfStage, class OfWhole>
std::vector<PlotSeries> curves(const std::vector<GrowthRow>& rows, const OfStage& of_stage, const OfWhole& of_whole) {
    std::vector<PlotSeries> all;
    for (std::size_t s = 0; s < kStages.size(); ++s) {
        all.push_back({kStages[s], {}});
        for (const GrowthRow& r : rows) all.back().points.emplace_back(r.surface_voxels, of_stage(r, s));
    }
    all.push_back({"whole run", {}});
    for (const GrowthRow& r : rows) all.back().points.emplace_back(r.surface_voxels, of_whole(r));
    return all;
}

std::string table_of(const std::vector<GrowthRow>& rows, const std::vector<PlotSeries>& series, const char* format,
                     double unit) {
    std::vector<std::string> heads{"resolution", "surface voxels"};
    for (const PlotSeries& s : series) heads.push_back(s.name);
    MarkdownTable table(heads);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        std::vector<std::string> cells{std::to_string(rows[i].resolution),
                                       fmt::format("{:.0f}", rows[i].surface_voxels)};
        for (const PlotSeries& s : series) cells.push_back(fmt::format(fmt::runtime(format), s.points[i].y() / unit));
        table.add(cells);
    }
    std::vector<std::string> exponents{"**exponent**", ""};
    for (const PlotSeries& s : series) {
        std::vector<Vec2> fitted;
        for (std::size_t i = 0; i < rows.size(); ++i)
            if (rows[i].resolution >= kLeastFittedResolution) fitted.push_back(s.points[i]);
        exponents.push_back(fitted.size() < 2 ? "-" : fmt::format("**{:.2f}**", fitted_exponent(fitted)));
    }
    table.add(exponents);
    return table.text();
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Growth of time and memory with resolution");
    app.add_option("--data", options.data, "folder with meshes/bunny_cgal.off; a made vase without")
        ->check(CLI::ExistingDirectory);
    app.add_option("--pattern", options.pattern, "built-in pattern");
    app.add_option("--largest", options.largest, "last resolution; 1024 takes some minutes more");
    app.add_option("--images", options.images, "folder for growth-seconds.svg and growth-memory.svg")
        ->check(CLI::ExistingDirectory);
    app.add_option("--write", options.document, "document whose section 'growth' is replaced");
    CLI11_PARSE(app, argc, argv);
    return publish("growth", options.document, "growth", [&] {
        std::vector<GrowthRow> rows;
        for (const int resolution : {64, 96, 128, 192, 256, 384, 512, 1024}) {
            if (resolution > options.largest) break;
            rows.push_back(measure(options, resolution));
            fmt::print(stderr, "{}: {:.1f} s, {:.2f} GB\n", resolution, rows.back().seconds_total,
                       rows.back().bytes_peak * 1e-9);
        }
        const auto seconds = curves(
            rows, [](const GrowthRow& r, std::size_t s) { return r.seconds[s]; },
            [](const GrowthRow& r) { return r.seconds_total; });
        const auto bytes = curves(
            rows, [](const GrowthRow& r, std::size_t s) { return r.bytes[s]; },
            [](const GrowthRow& r) { return r.bytes_peak; });
        if (!options.images.empty()) {
            atomic_write(fs::path(options.images) / "growth-seconds.svg",
                         log_log_plot({"Seconds per stage", "surface voxels", "s"}, seconds));
            atomic_write(fs::path(options.images) / "growth-memory.svg",
                         log_log_plot({"Peak memory during each stage", "surface voxels", "bytes"}, bytes));
        }
        std::string text = fmt::format(
            "{}, pattern `{}`, each row a process of its own. Exponents: fits of c x^p to the surface "
            "voxels, from {} voxels on.\n\n",
            options.data.empty() ? "A made vase" : "Bunny", options.pattern, kLeastFittedResolution);
        if (!options.images.empty())
            text += "![Seconds per stage](images/growth-seconds.svg)\n![Peak memory](images/growth-memory.svg)\n\n";
        text += "Seconds of wall clock:\n\n" + table_of(rows, seconds, "{:.2f}", 1.0);
        text += "\nPeak memory during the stage, MB (all that is held, not only what the stage has added):\n\n" +
                table_of(rows, bytes, "{:.0f}", 1e6);
        return text;
    });
}
