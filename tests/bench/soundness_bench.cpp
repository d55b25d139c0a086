// Table 3 of the paper: stress of carved models, every voxel a finite element, when the pattern is only joined, when it
// is reinforced for its weight, and when the geodesic criterion comes on top; under the weight it was designed for and
// under one it was not. Markdown on stdout or into a document's section.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "child_process.h"
#include "formats/mesh_file.h"
#include "markdown.h"
#include "soundness_run.h"

namespace {

using namespace fretwork;
using namespace fretwork::bench;
using Json = nlohmann::json;
namespace fs = std::filesystem;

struct Options {
    std::string data, document, only;
    std::vector<std::string> patterns = {"waves", "hooks"};
    int resolution = kDefaultResolution;
};

struct Model {
    const char *name, *file;
    UpAxis up;
};
constexpr std::array kModels = {Model{"bunny", "bunny_cgal.off", UpAxis::kY}, Model{"kitten", "kitten.off", UpAxis::kZ},
                                Model{"skull", "skull_low.obj", UpAxis::kZ}};

enum Scheme { kConnected, kForces, kForcesGeodesic, kHandling, kNaive, kNaiveTwice, kSchemes };
constexpr std::array<const char*, kSchemes> kSchemeNames = {
    "connected", "forces only", "forces + geodesic", "handling loads", "naive, same material", "naive, twice as much"};

struct Measure {
    const char *key, *name;
    std::array<double, 3> paper_expected, paper_unexpected;  ///< Pa, of its first three schemes
};
constexpr std::array kMeasures = {
    Measure{"average", "average", {16388.5, 5680.4, 5418.16}, {87039.1, 23509.8, 20111.5}},
    Measure{"median", "median", {3961.5, 3686.61, 3444.95}, {20770.5, 10374.6, 9762.0}},
    Measure{"p99", "99th percentile", {153947.0, 31720.7, 30486.6}, {693773.5, 185775.0, 145854.0}}};

Settings settings_of(const Options& options, const Model& model, const std::string& pattern, Scheme scheme) {
    Settings settings;
    settings.input.size_mm = 100.0;
    settings.input.up = model.up;
    settings.shell.resolution = options.resolution;
    settings.exemplar.pattern = pattern;
    settings.structure.material = "ABS";
    settings.structure.profile = scheme == kHandling ? LoadProfile::kHandling : LoadProfile::kGravity;
    if (scheme == kConnected) settings.structure.steps.max_iterations = 1;
    if (scheme == kConnected || scheme == kForces) settings.structure.steps.geodesic_factor = 0.0;
    return settings;
}

Json numbers_of(const StressStatistics& stress) {
    return {{"average", stress.average_pa}, {"median", stress.median_pa}, {"p99", stress.p99_pa}};
}

/// In the child. \param earlier  what the schemes before this one came to
std::string run_scheme(const Options& options, const Model& model, const std::string& pattern, Scheme scheme,
                       const std::vector<Json>& earlier) {
    const TriangleMesh mesh = read_mesh(fs::path(options.data) / "meshes" / model.file).mesh;
    const Settings settings = settings_of(options, model, pattern, scheme);
    SoundnessRun run;
    if (scheme == kNaive || scheme == kNaiveTwice) {
        const auto connected = earlier[kConnected]["solid_voxels"].get<std::size_t>();
        const std::size_t added = earlier[kForcesGeodesic]["solid_voxels"].get<std::size_t>() - connected;
        run = run_naively(mesh, settings, connected + (scheme == kNaiveTwice ? 2 * added : added));
    } else {
        run = run_soundness(mesh, settings);
    }
    const Json json{{"expected", numbers_of(run.expected)},
                    {"unexpected", numbers_of(run.unexpected)},
                    {"solid", run.solid_fraction},
                    {"solid_voxels", run.solid_voxels},
                    {"volume", run.volume_mm3},
                    {"turns", run.turns},
                    {"bridges", run.bridges},
                    {"patches_first", run.patches_first},
                    {"patches", run.patches},
                    {"seams_first", run.seams_first},
                    {"seams", run.seams}};
    return json.dump();
}

void add_rows(MarkdownTable& table, const std::string& object, const std::vector<Json>& runs, const char* load) {
    for (const Measure& measure : kMeasures) {
        std::vector<std::string> row = {object, fmt::format("{}, {}", load, measure.name)};
        const double first = runs[kConnected][load][measure.key].get<double>();
        for (const Json& run : runs) {
            const double pa = run[load][measure.key].get<double>();
            row.push_back(fmt::format("{:.0f} ({:.2f})", pa, pa / first));
        }
        table.add(row);
    }
}

void add_paper(MarkdownTable& table, const char* load, bool expected) {
    for (const Measure& measure : kMeasures) {
        const std::array<double, 3>& pa = expected ? measure.paper_expected : measure.paper_unexpected;
        std::vector<std::string> row = {"paper", fmt::format("{}, {}", load, measure.name)};
        for (const double value : pa) row.push_back(fmt::format("{:.0f} ({:.2f})", value, value / pa[0]));
        row.resize(2 + kSchemes, "-");
        table.add(row);
    }
}

/// What a scheme costs, beside the joined pattern.
void add_costs(MarkdownTable& table, const std::string& object, const std::vector<Json>& runs) {
    const auto row = [&](const char* what, const auto& cell) {
        std::vector<std::string> cells = {object, what};
        for (const Json& run : runs) cells.push_back(cell(run));
        table.add(cells);
    };
    const auto number = [](const Json& run, const char* key) { return run[key].get<double>(); };
    row("solid share, volume mm3",
        [&](const Json& run) { return fmt::format("{:.3f}, {:.0f}", number(run, "solid"), number(run, "volume")); });
    const double volume = number(runs[kConnected], "volume");
    row("added material",
        [&](const Json& run) { return fmt::format("{:.1f} %", 100.0 * (number(run, "volume") - volume) / volume); });
    row("bridges, turns",
        [&](const Json& run) { return fmt::format("{}, {}", run["bridges"].get<int>(), run["turns"].get<int>()); });
    row("patch similarity", [&](const Json& run) {
        return fmt::format("{:.3f} -> {:.3f}", number(run, "patches_first"), number(run, "patches"));
    });
    row("worst seams", [&](const Json& run) {
        return fmt::format("{:.3f} -> {:.3f}", number(run, "seams_first"), number(run, "seams"));
    });
}

std::vector<Json> run_schemes(const Options& options, const Model& model, const std::string& pattern,
                              const std::string& object) {
    std::vector<Json> runs;
    for (int scheme = 0; scheme < kSchemes; ++scheme) {
        const ChildResult child =
            run_in_child([&] { return run_scheme(options, model, pattern, static_cast<Scheme>(scheme), runs); });
        if (child.exit_code != 0) throw std::runtime_error(fmt::format("{}: the run failed", object));
        fmt::print(stderr, "{}, {}: {}\n", object, kSchemeNames.at(static_cast<std::size_t>(scheme)), child.output);
        runs.push_back(Json::parse(child.output));
    }
    return runs;
}

std::string measured(const Options& options) {
    std::vector<std::string> heads = {"model, pattern", "load, measure"};
    heads.insert(heads.end(), kSchemeNames.begin(), kSchemeNames.end());
    MarkdownTable stress(heads);
    heads[1] = "cost";
    MarkdownTable cost(heads);
    add_paper(stress, "expected", true);
    add_paper(stress, "unexpected", false);
    for (const Model& model : kModels) {
        for (const std::string& pattern : options.patterns) {
            const std::string object = fmt::format("{}, {}", model.name, pattern);
            if (object.find(options.only) == object.npos) continue;
            const std::vector<Json> runs = run_schemes(options, model, pattern, object);
            add_rows(stress, object, runs, "expected");
            add_rows(stress, object, runs, "unexpected");
            add_costs(cost, object, runs);
        }
    }
    return fmt::format(
        "100 mm, {} voxels, ABS, |s1| + |s2| + |s3| in Pa, in brackets the share of *connected*. *Expected*: weight "
        "along -z. *Unexpected*: along x. Both are held at the lowest tenth.\n\n{}\nAdded material is that of the "
        "wall as it is printed, beyond *connected*. Patch similarity and worst seams (0 = as alike as can be) go from "
        "the first synthesis to the result.\n\n{}",
        options.resolution, stress.text(), cost.text());
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Stress of carved models by how they were reinforced");
    app.add_option("data", options.data, "folder with meshes/")->required()->check(CLI::ExistingDirectory);
    app.add_option("--pattern", options.patterns, "built-in patterns");
    app.add_option("--resolution", options.resolution, "voxels along the longest side");
    app.add_option("--only", options.only, "rows whose name holds this");
    app.add_option("--write", options.document, "document whose section 'soundness' is replaced");
    CLI11_PARSE(app, argc, argv);
    return publish("soundness_bench", options.document, "soundness", [&] { return measured(options); });
}
