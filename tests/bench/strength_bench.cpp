// Time and memory of the full analysis of carved models, stresses on them, and how well the beams of the design foresee
// them. Markdown on stdout or into a document's section.
#include <fmt/format.h>
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>
#include <vector>

#include "child_process.h"
#include "core/fem/beam_model.h"
#include "core/fem/beam_widths.h"
#include "core/graph/connect_samples.h"
#include "core/graph/poisson_disk.h"
#include "core/mesh/nearest_point.h"
#include "core/pipeline/carve.h"
#include "core/pipeline/choose_exemplar.h"
#include "core/pipeline/memory_use.h"
#include "core/shell/components.h"
#include "core/strength/strength.h"
#include "formats/mesh_file.h"
#include "formats/scratch_folder.h"
#include "markdown.h"

namespace {

using namespace fretwork;
using namespace fretwork::bench;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;
namespace fs = std::filesystem;

struct Options {
    std::string data, pattern = "cells", document, only;
};

struct Row {
    std::string name, file;  ///< in meshes/, or .awk: made by a program in examples/models
    int resolution;          ///< voxels of the analysis along the longest side
    double seconds_asked;    ///< 0: nothing is asked
    double gb_asked;
};

const std::vector<Row>& rows() {
    static const std::vector<Row> all = {
        {"bunny", "bunny_cgal.off", 256, 20.0, 2.0}, {"bunny, finer", "bunny_cgal.off", 400, 90.0, 6.0},
        {"kitten", "kitten.off", 256, 0.0, 0.0},     {"skull", "skull_low.obj", 256, 0.0, 0.0},
        {"vase", "vase.awk", 256, 0.0, 0.0},         {"bracket", "bracket.awk", 256, 0.0, 0.0}};
    return all;
}

double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

TriangleMesh mesh_of(const Options& options, const Row& row) {
    if (!row.file.ends_with(".awk")) return read_mesh(fs::path(options.data) / "meshes" / row.file).mesh;
    const ScratchFolder scratch;
    const fs::path off = scratch / (row.name + ".off");
    const std::string command =
        fmt::format("awk -f '{}/examples/models/{}' > '{}'", FRETWORK_REPOSITORY, row.file, off.string());
    if (std::system(command.c_str()) != 0) throw std::runtime_error(fmt::format("{} makes no mesh", row.file));
    return read_mesh(off).mesh;
}

CarveResult carved(const Options& options, const Row& row) {
    Settings settings;
    settings.input.size_mm = 100.0;
    if (row.name.starts_with("bunny")) settings.input.up = UpAxis::kY;
    settings.exemplar.pattern = options.pattern;
    settings.structure.material = "ABS";
    ChosenExemplar chosen = builtin_exemplar(settings.exemplar);
    CarveInput input;
    input.mesh = mesh_of(options, row);
    input.model_name = row.name;
    input.exemplar = std::move(chosen.exemplar);
    input.exemplar_name = chosen.name;
    input.exemplar_width_mm = chosen.natural_width_mm;
    return carve(input, settings);
}

/// Ranks from 0, ties share their mean.
std::vector<double> ranks_of(const std::vector<double>& values) {
    std::vector<std::size_t> order(values.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return values[i]; });
    std::vector<double> ranks(values.size());
    for (std::size_t i = 0; i < order.size();) {
        std::size_t end = i;
        while (end < order.size() && values[order[end]] == values[order[i]]) ++end;
        for (std::size_t j = i; j < end; ++j) ranks[order[j]] = 0.5 * static_cast<double>(i + end - 1);
        i = end;
    }
    return ranks;
}

double rank_correlation(const std::vector<double>& a, const std::vector<double>& b) {
    const std::vector<double> x = ranks_of(a), y = ranks_of(b);
    const double middle = 0.5 * (static_cast<double>(x.size()) - 1.0);
    double xy = 0.0, xx = 0.0, yy = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        xy += (x[i] - middle) * (y[i] - middle);
        xx += (x[i] - middle) * (x[i] - middle);
        yy += (y[i] - middle) * (y[i] - middle);
    }
    return xy / std::sqrt(xx * yy);
}

/// Over regions of the samples that nothing holds: the mean score of the edges at a sample against the 95th percentile
/// of the voxels in its region, over the cases of a profile.
double foresight(const CarveResult& carve, const VoxelModel& model, const std::vector<float>& stress_pa,
                 const ForceProfile& profile, const Material& material, const ReinforceSettings& wall) {
    const SurfaceVoxels& shell = carve.shell;
    Samples samples =
        poisson_samples(shell.adjacency, connected_components(shell.adjacency), carve.solid, SampleSettings{});
    const AbstractGraph graph =
        connect_samples(shell.adjacency, carve.solid, std::move(samples.voxels), ExtendFrom::kTree);
    BeamModelSettings settings;
    settings.thickness_mm = wall.thickness_mm;
    settings.facing = facing_voxels(shell, wall.inner_wall_mm);
    BeamModel beams(shell, carve.solid, graph, beam_half_widths(shell, carve.solid), profile, material, settings);
    std::vector<EdgeState> states;
    for (const AbstractEdge& edge : graph.edges) states.push_back(edge.state);
    const std::vector<double> scores = beams.edge_scores_pa(states);

    std::vector<double> foreseen(graph.samples.size(), 0.0);
    std::vector<int> edges(graph.samples.size(), 0);
    for (std::size_t e = 0; e < scores.size(); ++e)
        if (states[e] == EdgeState::kSolid)
            for (const SampleIndex s : {graph.edges[e].a, graph.edges[e].b}) {
                foreseen[s] += scores[e];
                ++edges[s];
            }
    std::vector<std::vector<float>> region(graph.samples.size());
    const NearestPoint entries(shell.points_mm);
    for (std::size_t v = 0; v < model.voxels.size(); ++v) {
        const SampleIndex sample = graph.owner[entries.to(model.grid.center_mm(model.voxels[v]))];
        if (sample != kNoSample) region[sample].push_back(stress_pa[v]);
    }
    std::vector<double> found, matching;
    for (std::size_t s = 0; s < region.size(); ++s) {
        const bool held = std::ranges::binary_search(profile.cases.front().fixed, graph.samples[s]);
        if (region[s].size() < 20 || edges[s] == 0 || held) continue;
        const auto nth = region[s].begin() + static_cast<std::ptrdiff_t>(region[s].size() * 95 / 100);
        std::nth_element(region[s].begin(), nth, region[s].end());
        found.push_back(double{*nth});
        matching.push_back(foreseen[s] / edges[s]);
    }
    return rank_correlation(found, matching);
}

StrengthSettings analysis_settings(std::uint64_t most_bytes) {
    StrengthSettings settings;
    settings.material = material_by_name("ABS");
    settings.max_memory_bytes = most_bytes;
    return settings;
}

/// In the child: carve, and then only what the analysis takes.
std::string run_row(const Options& options, const Row& row) {
    TriangleMesh mesh = carved(options, row).carved.mesh;
    malloc_trim(0);
    restart_peak_memory();
    const auto start = Clock::now();
    const VoxelModel model = make_voxel_model(mesh, 100.0 / row.resolution);
    const double seconds_voxels = seconds_since(start);
    const StrengthReport report =
        analyze_strength(model, self_weight_cases(model), analysis_settings(std::uint64_t{6} << 30));
    Json json{{"seconds", seconds_since(start)},
              {"seconds_voxels", seconds_voxels},
              {"peak", peak_memory_bytes()},
              {"triangles", mesh.triangles.size()},
              {"voxels", report.voxels},
              {"nodes", report.nodes},
              {"joining", report.joining_voxels},
              {"pieces", report.pieces},
              {"factor_bytes", report.factor_bytes},
              {"estimate", memory_for(model, 3) + report.factor_bytes},
              {"average", report.cases[2].stress_sum.average_pa},
              {"median", report.cases[2].stress_sum.median_pa},
              {"p99", report.cases[2].stress_sum.p99_pa},
              {"max", report.cases[2].stress_sum.max_pa},
              {"moved", report.cases[2].max_displacement_mm},
              {"factor", report.least_factor}};
    for (const StrengthCase& load_case : report.cases) json["iterations"].push_back(load_case.iterations);
    return json.dump();
}

/// In the child: what the beams foresee under weight and under the handling loads.
std::string foresee_row(const Options& options, const Row& row) {
    const CarveResult carve = carved(options, row);
    const VoxelModel model = make_voxel_model(carve.carved.mesh, 100.0 / row.resolution);
    ReinforceSettings wall;
    wall.thickness_mm = carve.report.shell.thickness_mm;
    // An open surface has its wall to both sides.
    wall.inner_wall_mm = (carve.report.input.mesh.border_edges == 0 ? 1.0 : 0.5) * wall.thickness_mm;
    const StrengthSettings settings = analysis_settings(std::uint64_t{6} << 30);
    ForceProfile weight, handling;
    weight.cases.push_back(gravity_case(carve.shell, -Vec3::UnitZ()));
    handling.cases = handling_cases(carve.shell);
    Json json;
    for (const auto& [name, profile] : {std::pair("weight", &weight), std::pair("handling", &handling)}) {
        const StrengthReport report = analyze_strength(model, cases_of(*profile, carve.shell, model), settings);
        json[name] = foresight(carve, model, report.worst_stress_sum_pa, *profile, settings.material, wall);
    }
    return json.dump();
}

Json in_child(const Options& options, const Row& row, std::string (*work)(const Options&, const Row&)) {
    const ChildResult child = run_in_child([&] { return work(options, row); });
    if (child.exit_code != 0) throw std::runtime_error(fmt::format("{}: the run failed", row.name));
    return Json::parse(child.output);
}

std::string asked(double value, double limit, const char* unit) {
    if (limit == 0.0) return fmt::format("{:.2f} {}", value, unit);
    return fmt::format("{:.2f} of {:g} {}{}", value, limit, unit, value <= limit ? "" : " **no**");
}

std::string measured(const Options& options) {
    MarkdownTable cost({"model", "voxels", "nodes", "joined", "voxelise", "whole analysis", "peak memory",
                        "foreseen memory", "iterations"});
    MarkdownTable stress({"model", "average kPa", "median kPa", "99 % kPa", "max kPa", "moved um", "factor of safety",
                          "beams against voxels: weight", "handling loads"});
    for (const Row& row : rows()) {
        if (row.name.find(options.only) == row.name.npos) continue;
        const Json run = in_child(options, row, run_row);
        std::vector<std::string> turns;
        for (const Json& count : run["iterations"]) turns.push_back(std::to_string(count.get<int>()));
        cost.add({fmt::format("{}, {}^3", row.name, row.resolution), std::to_string(run["voxels"].get<long>()),
                  std::to_string(run["nodes"].get<long>()), std::to_string(run["joining"].get<long>()),
                  fmt::format("{:.2f} s", run["seconds_voxels"].get<double>()),
                  asked(run["seconds"], row.seconds_asked, "s"),
                  asked(run["peak"].get<double>() * 1e-9, row.gb_asked, "GB"),
                  fmt::format("{:.2f} GB", run["estimate"].get<double>() * 1e-9),
                  fmt::format("{}", fmt::join(turns, ", "))});
        const Json foreseen = in_child(options, row, foresee_row);
        const auto kpa = [&](const char* key) { return fmt::format("{:.2f}", run[key].get<double>() * 1e-3); };
        stress.add({fmt::format("{}, {}^3", row.name, row.resolution), kpa("average"), kpa("median"), kpa("p99"),
                    kpa("max"), fmt::format("{:.2f}", run["moved"].get<double>() * 1e3),
                    fmt::format("{:.0f}", run["factor"].get<double>()),
                    fmt::format("{:.2f}", foreseen["weight"].get<double>()),
                    fmt::format("{:.2f}", foreseen["handling"].get<double>())});
        fmt::print(stderr, "{}: {}\n  foreseen {}\n", row.name, run.dump(), foreseen.dump());
    }
    return fmt::format(
        "Pattern `{}`, 100 mm, ABS, self-weight in three directions, each row a process of its own.\n\n{}\n"
        "Sum of principal stresses under weight along -z; factor of safety over the three directions; rank correlation "
        "(Spearman) of the beams' scores with the voxels' stress under weight along -z and under the handling "
        "loads.\n\n{}",
        options.pattern, cost.text(), stress.text());
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Full analysis of carved models");
    app.add_option("data", options.data, "folder with meshes/")->required()->check(CLI::ExistingDirectory);
    app.add_option("--pattern", options.pattern, "built-in pattern");
    app.add_option("--only", options.only, "rows whose name holds this");
    app.add_option("--write", options.document, "document whose section 'strength' is replaced");
    CLI11_PARSE(app, argc, argv);
    return publish("strength_bench", options.document, "strength", [&] { return measured(options); });
}
