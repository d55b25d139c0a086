// Tables 1 and 2 of the paper beside ours, in Markdown on stdout.
//   paper_tables DATA_FOLDER [bunny|kitten|skull [PATTERN]]
// DATA_FOLDER holds `meshes/` and `exemplars/`; rows whose files are absent are named and skipped. The paper's
// figures come from hardware that it does not state; compare ratios between rows, and runs on one machine.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/pipeline/carve.h"
#include "core/pipeline/choose_exemplar.h"
#include "core/pipeline/settings_schema.h"
#include "formats/image_file.h"
#include "formats/mesh_file.h"

namespace {

using namespace fretwork;
namespace fs = std::filesystem;

struct Row {
    std::string model, texture;
    std::string mesh_file;      ///< below meshes/
    std::string exemplar_file;  ///< below exemplars/; empty: the built-in pattern of that name
    int grid;
    int paper_voxels, paper_iterations;
    double paper_first_s, paper_total_s;                         // Table 1
    std::optional<double> paper_synthesis_s, paper_structure_s;  // Table 2
};

std::vector<Row> rows() {
    return {
        {"bunny", "keyboard", "bunny_cgal.off", "", 256, 67651, 4, 1.11, 14.6, 8.6, 4.6},
        {"bunny", "bluebrown", "bunny_cgal.off", "c_bluebrown.png", 256, 84292, 10, 1.11, 34.8, 23.8, 12.1},
        {"bunny", "greencells", "bunny_cgal.off", "c_greencells.png", 256, 80917, 3, 1.11, 11.4, 8.3, 4.9},
        {"bunny", "hooks", "bunny_cgal.off", "", 256, 55356, 11, 1.11, 40.0, 28.4, 10.5},
        {"bunny", "waves", "bunny_cgal.off", "c_waves.png", 256, 107038, 10, 1.11, 52.4, 37.3, 13.9},
        {"bunny", "animalskin", "bunny_cgal.off", "c_animalskin.png", 256, 89110, 24, 1.30, 76.2, 45.5, 26.9},
        {"kitten", "hooks", "kitten.off", "", 256, 38626, 8, 0.9, 24.3, {}, {}},
        {"skull", "hooks", "skull_low.obj", "", 512, 241652, 4, 5.9, 40.3, {}, {}},
    };
}

double seconds_of(const RunReport& report, std::string_view stage) {
    double sum = 0.0;
    for (const StageSeconds& s : report.seconds)
        if (s.stage == stage) sum += s.seconds;
    return sum;
}

RunReport run_row(const Row& row, const fs::path& data) {
    Settings settings;
    settings.input.size_mm = 100.0;
    settings.shell.resolution = row.grid;
    ChosenExemplar chosen;
    if (row.exemplar_file.empty()) {
        settings.exemplar.pattern = row.texture;
        chosen = builtin_exemplar(settings.exemplar);
    } else {
        settings.exemplar.image = row.exemplar_file;
        chosen = picture_exemplar(settings.exemplar, read_image(data / "exemplars" / row.exemplar_file), nullptr);
    }
    CarveInput input;
    input.mesh = read_mesh(data / "meshes" / row.mesh_file).mesh;
    input.model_name = row.model;
    input.exemplar = std::move(chosen.exemplar);
    input.exemplar_name = chosen.name;
    input.exemplar_width_mm = chosen.natural_width_mm;
    return carve(input, settings).report;
}

std::string optional_seconds(const std::optional<double>& s) {
    return s ? fmt::format("{:.1f}", *s) : "-";
}

void print_row(const Row& row, const RunReport& r) {
    const double before = seconds_of(r, "voxelize") + seconds_of(r, "pyramid");
    const double first = seconds_of(r, "synthesize");
    const double loop = seconds_of(r, "reinforce");
    fmt::print(
        "| {}/{} | {} | {} / {} | {} / {} | {:.2f} | {:.2f} / {:.2f} | {:.1f} / {:.1f} | {} / {:.1f} | {} / {:.1f} | "
        "{:.1f} | {:.1f} | {:.2f} |\n",
        row.model, row.texture, row.grid, row.paper_voxels, r.pattern.solid_voxels, row.paper_iterations,
        r.iterations.size(), before, row.paper_first_s, first, row.paper_total_s, before + first + loop,
        optional_seconds(row.paper_synthesis_s), first + r.seconds_resynthesis, optional_seconds(row.paper_structure_s),
        loop - r.seconds_resynthesis, seconds_of(r, "solidify"), r.seconds_total,
        static_cast<double>(r.peak_memory_bytes) * 1e-9);
    std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 2) {
        fmt::print(stderr, "usage: paper_tables DATA_FOLDER [MODEL [TEXTURE]]\n");
        return 1;
    }
    const fs::path data = argv[1];
    fmt::print(
        "Each cell with a slash reads paper / ours. Seconds of wall clock; memory is the peak of the process so "
        "far.\n\n");
    fmt::print(
        "| model/texture | grid | solid voxels | iterations | voxelise + pyramid | t_init | t_total (Algorithm 1) | "
        "synthesis | structure | solidify | whole run | GB |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
    for (const Row& row : rows()) {
        if (argc > 2 && row.model != argv[2]) continue;
        if (argc > 3 && row.texture != argv[3]) continue;
        if (!fs::exists(data / "meshes" / row.mesh_file)) {
            fmt::print("| {}/{} | skipped: {} is not there |\n", row.model, row.texture, row.mesh_file);
            continue;
        }
        print_row(row, run_row(row, data));
    }
    return 0;
}
