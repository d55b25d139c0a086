// How alike our patterns and their exemplars are, on the scale crop < good 2D synthesis < patch tiling < noise.
// Markdown on stdout, or into a document's section. See likeness/likeness_meter.h for the measures.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/pipeline/choose_exemplar.h"
#include "core/pipeline/settings_schema.h"
#include "formats/image_file.h"
#include "formats/mesh_file.h"
#include "likeness/baselines.h"
#include "likeness/likeness_meter.h"
#include "likeness_report.h"
#include "markdown.h"
#include "pattern_run.h"
#include "support/make_meshes.h"

namespace {

using namespace fretwork;
using namespace fretwork::bench;
using namespace fretwork::likeness;
namespace fs = std::filesystem;

struct Options {
    std::string data, only, pictures, document;
    std::vector<std::string> trials;
    int seeds = 3, plate = 160, curved = 144;
    bool structure = true, paper = true;
};

/// What is compared: baselines and our own, in the order of the columns.
struct Variant {
    std::string name;
    Settings settings;
};

std::vector<BenchExemplar> exemplars(const Options& options) {
    std::vector<BenchExemplar> list;
    const auto wanted = [&](const std::string& name) {
        return options.only.empty() || ("," + options.only + ",").find("," + name + ",") != std::string::npos;
    };
    for (const char* name : {"cells", "lace", "celtic", "animalskin", "coral", "scales", "hooks", "waves", "zebra"})
        if (wanted(name)) list.push_back(make_bench_exemplar(name, make_builtin(name)));
    if (options.data.empty()) return list;
    std::vector<fs::path> files;
    for (const auto& entry : fs::directory_iterator(fs::path(options.data) / "exemplars")) files.push_back(entry);
    std::ranges::sort(files);
    for (const fs::path& file : files)
        if (wanted(file.stem())) list.push_back(make_bench_exemplar(file.stem(), make_exemplar(read_image(file))));
    return list;
}

std::vector<BenchModel> curved_models(const Options& options) {
    std::vector<BenchModel> models;
    if (options.curved <= 0) return models;
    models.push_back(make_model("vase", testing::make_vase(100, 96, 96), options.curved, false));
    const fs::path bunny = fs::path(options.data) / "meshes" / "bunny_cgal.off";
    if (options.data.empty() || !fs::exists(bunny)) {
        models.push_back(make_model("torus", testing::make_torus(36, 14, 96, 48), options.curved, false));
        return models;
    }
    TriangleMesh mesh = read_mesh(bunny).mesh;
    for (Vec3& p : mesh.positions_mm) p = Vec3(p.x(), -p.z(), p.y());  // y is up in that file
    models.push_back(make_model("bunny", std::move(mesh), options.curved, false));
    return models;
}

std::vector<Variant> variants(const Options& options) {
    std::vector<Variant> list{{"default", {}}};
    if (options.paper) {
        list.push_back({"paper", {}});
        apply_preset(list.back().settings, Preset::kPaper);
    }
    for (const std::string& trial : options.trials) {
        Variant v{trial, {}};
        for (std::size_t at = 0; at < trial.size();) {
            const std::size_t end = std::min(trial.find(';', at), trial.size());
            apply_setting(v.settings, parse_assignment(trial.substr(at, end - at), "--trial"));
            at = end + 1;
        }
        list.push_back(std::move(v));
    }
    return list;
}

void save(const Options& options, const std::string& name, const PatternPicture& picture) {
    if (options.pictures.empty()) return;
    Image image{picture.width, picture.height, {}, false};
    const auto byte = [](float value) { return static_cast<std::uint8_t>(std::clamp(value, 0.0F, 1.0F) * 255 + 0.5F); };
    for (const PatternPixel& p : picture.pixels) image.pixels.push_back({byte(p[0]), byte(p[1]), byte(p[2]), 255});
    write_image(fs::path(options.pictures) / (name + ".png"), image);
}

/// Flat windows as many as are gathered on a curved model, so that both are measured alike.
std::vector<Windows> flat_windows(PatternPicture picture, std::size_t count, int levels, std::uint64_t seed) {
    std::vector<Windows> result;
    for (int l = 0; l < levels; ++l) {
        if (l > 0) picture = halved(picture);
        result.push_back(some_windows(all_windows(picture), count, seed).windows);
    }
    return result;
}

constexpr MeterSettings kCurvedMeter{.samples = 400, .levels = 2};
constexpr std::size_t kCurvedWindows = 1000;

struct Meters {
    LikenessMeter flat, curved;
};

void measure_baselines(const Options& options, const BenchExemplar& e, const Meters& meters, std::uint64_t seed,
                       ExemplarResult& result) {
    using MakeMap = SourceMap (*)(const PatternPicture&, int, std::uint64_t);
    const std::pair<const char*, MakeMap> baselines[] = {
        {"crop", crop_map}, {"2D synthesis", synthesized_map}, {"tiling", tiled_map}, {"noise", noise_map}};
    for (const auto& [name, make_map] : baselines) {
        const PatternPicture picture =
            likeness::picture_of(make_map(e.reference, options.plate, seed), e.reference, seed);
        save(options, fmt::format("{}-{}-{}", e.name, name, seed), picture);
        result.flat[name].by_seed.push_back(meters.flat.measure(picture));
        result.flat[name].solid_fraction.push_back(picture.solid_fraction());
        if (options.curved > 0)
            result.curved["flat"][name].by_seed.push_back(
                meters.curved.measure(flat_windows(picture, kCurvedWindows, kCurvedMeter.levels, seed)));
    }
}

void measure_flat(const Options& options, const BenchModel& plate, const BenchExemplar& e, const Meters& meters,
                  const Variant& variant, std::uint64_t seed, ExemplarResult& result) {
    Settings settings = variant.settings;
    settings.synthesis.search.seed = seed;
    // Nobody pinches a sheet across its plane; the handling loads of the default are meant for closed objects.
    settings.structure.profile = LoadProfile::kGravity;
    const PatternRun run =
        run_pattern(plate, e, settings, options.structure ? WithStructure::kYes : WithStructure::kNo);
    const auto note = [&](const std::string& column, const ShownPattern& pattern, double solid_fraction) {
        const PatternPicture picture = plate_picture(plate, pattern, e.reference);
        save(options, fmt::format("{}-{}-{}", e.name, column, seed), picture);
        Series& series = result.flat[column];
        series.by_seed.push_back(meters.flat.measure(picture));
        series.solid_fraction.push_back(solid_fraction);
    };
    note(variant.name, run.first, run.solid_fraction);
    if (!options.structure) return;
    note(variant.name + ", painted", run.painted, run.solid_fraction_after);
    note(variant.name + ", resynthesised", run.resynthesized, run.solid_fraction_after);
}

/// Reinforcement is measured on the first of the curved models, with the default preset.
bool is_reinforced(const Options& options, const std::vector<BenchModel>& curved, const BenchModel& model,
                   const Variant& variant) {
    return options.structure && &model == &curved.front() && variant.name == "default";
}

void measure_curved(const BenchModel& model, const BenchExemplar& e, const Meters& meters, const Variant& variant,
                    std::uint64_t seed, WithStructure structure, ExemplarResult& result) {
    Settings settings = variant.settings;
    settings.synthesis.search.seed = seed;
    const PatternRun run = run_pattern(model, e, settings, structure);
    const auto note = [&](const std::string& column, const ShownPattern& pattern, double solid_fraction) {
        Series& series = result.curved[model.name][column];
        series.by_seed.push_back(meters.curved.measure(
            surface_windows(model.pyramid.levels[0], pattern, e.reference, kCurvedWindows, kCurvedMeter.levels, seed)));
        series.solid_fraction.push_back(solid_fraction);
    };
    note(variant.name, run.first, run.solid_fraction);
    if (structure == WithStructure::kNo) return;
    note(variant.name + ", painted", run.painted, run.solid_fraction_after);
    note(variant.name + ", resynthesised", run.resynthesized, run.solid_fraction_after);
}

ExemplarResult measure(const Options& options, const BenchExemplar& e, const BenchModel& plate,
                       const std::vector<BenchModel>& curved) {
    ExemplarResult result{e.name, e.reference.solid_fraction(), {}, {}};
    const Meters meters{LikenessMeter(e.reference), LikenessMeter(e.reference, kCurvedMeter)};
    for (int s = 1; s <= options.seeds; ++s) {
        const auto seed = static_cast<std::uint64_t>(s);
        measure_baselines(options, e, meters, seed, result);
        for (const Variant& variant : variants(options)) {
            measure_flat(options, plate, e, meters, variant, seed, result);
            for (const BenchModel& model : curved) {
                if (variant.name == "paper" && &model != &curved.front()) continue;  // slow, and one shows it
                const bool reinforced = is_reinforced(options, curved, model, variant);
                measure_curved(model, e, meters, variant, seed, reinforced ? WithStructure::kYes : WithStructure::kNo,
                               result);
            }
        }
    }
    return result;
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("How alike patterns and their exemplars are");
    app.add_option("--data", options.data, "folder with exemplars/ and meshes/")->check(CLI::ExistingDirectory);
    app.add_option("--only", options.only, "exemplars, separated by commas");
    app.add_option("--seeds", options.seeds, "runs per exemplar")->check(CLI::Range(1, 100));
    app.add_option("--plate", options.plate, "voxels along the plate")->check(CLI::Range(64, 1024));
    app.add_option("--curved", options.curved, "voxels along curved models; 0 leaves them out")
        ->check(CLI::Range(0, 1024));
    app.add_option("--trial", options.trials, "one more column: key=value, several separated by ';'");
    app.add_flag("!--no-structure", options.structure, "leave reinforcement out");
    app.add_flag("!--no-paper", options.paper, "leave the preset 'paper' out");
    app.add_option("--pictures", options.pictures, "folder for pictures of all plates")->check(CLI::ExistingDirectory);
    app.add_option("--write", options.document, "document whose section 'likeness' is replaced");
    CLI11_PARSE(app, argc, argv);
    return publish("likeness", options.document, "likeness", [&] {
        const BenchModel plate = make_plate(options.plate);
        const std::vector<BenchModel> curved = curved_models(options);
        std::vector<ExemplarResult> results;
        for (const BenchExemplar& e : exemplars(options)) {
            results.push_back(measure(options, e, plate, curved));
            const Likeness ours = results.back().flat.at("default").mean();
            fmt::print(stderr, "{}: patches {:.3f}, worst seams {:.3f}\n", e.name, ours.patches(), ours.worst_seam);
        }
        if (results.empty()) throw std::runtime_error("no exemplar of that name");
        LikenessReportSettings report{
            options.seeds, options.plate, options.curved, kCurvedWindows, options.structure, {}, {}};
        for (const Variant& v : variants(options)) report.variants.push_back(v.name);
        for (const BenchModel& m : curved) report.models.push_back(m.name);
        return likeness_report(report, results);
    });
}
