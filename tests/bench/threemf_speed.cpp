// Seconds and peak memory of reading and writing one large 3MF: ours beside PrusaSlicer's and lib3mf's. Each figure
// comes from a process of its own; the model is made by the program. Markdown on stdout or into a document's section.
#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "child_process.h"
#include "core/pipeline/memory_use.h"
#include "formats/carved_threemf_writer.h"
#include "formats/mesh_file.h"
#include "formats/read_file.h"
#include "formats/scratch_folder.h"
#include "formats/volumetric_reader.h"
#include "markdown.h"
#include "speed_model.h"
#include "support/make_meshes.h"
#ifdef FRETWORK_LIB3MF
#include "lib3mf_peer.h"
#endif

namespace {

using namespace fretwork;
using namespace fretwork::bench;
namespace fs = std::filesystem;

struct Options {
    int side = 1000;  ///< 2 side^2 triangles
    int cells = 256;
    int repeats = 3;
    std::string only, document;
};

struct Cost {
    double seconds = 0.0;
    double cpu_seconds = 0.0;
    std::uint64_t peak_bytes = 0;
};

/// The least of each: what other work on the machine adds is never negative.
Cost least(const Cost& a, const Cost& b) {
    return {std::min(a.seconds, b.seconds), std::min(a.cpu_seconds, b.cpu_seconds),
            std::min(a.peak_bytes, b.peak_bytes)};
}

double cpu_seconds() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) {
        return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
    };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

/// In the child: cost of `work` as text, without that of what came before it.
std::string cost_of(const std::function<void()>& work) {
    if (!restart_peak_memory()) throw std::runtime_error("the system does not start the peak of memory afresh");
    const double cpu = cpu_seconds();
    const auto start = std::chrono::steady_clock::now();
    work();
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return fmt::format("{} {} {}", seconds, cpu_seconds() - cpu, peak_memory_bytes());
}

Cost in_child(const std::function<std::string()>& work) {
    const ChildResult child = run_in_child(work);
    if (child.exit_code != 0) throw std::runtime_error("a measured process failed");
    Cost cost;
    std::istringstream(child.output) >> cost.seconds >> cost.cpu_seconds >> cost.peak_bytes;
    return cost;
}

void expect(std::uint64_t found, std::uint64_t expected, const char* what) {
    if (found != expected) throw std::runtime_error(fmt::format("{} {}, expected {}", found, what, expected));
}

/// The files of this run and who makes and reads them.
class Jobs {
  public:
    explicit Jobs(const Options& options) : options_(options) {
        // Not here: threads of this process would be missing in its children.
        const ChildResult child = run_in_child([this] {
            write_mesh(tiny(), {testing::make_box(Vec3(0, 0, 0), Vec3(1, 1, 1))});
            return std::string();
        });
        if (child.exit_code != 0) throw std::runtime_error("no file could be written");
    }

    [[nodiscard]] fs::path full() const { return scratch_.path() / "full.3mf"; }
    [[nodiscard]] fs::path plain() const { return scratch_.path() / "plain.3mf"; }
    [[nodiscard]] fs::path tiny() const { return scratch_.path() / "tiny.3mf"; }
    [[nodiscard]] std::uint64_t triangles() const {
        return 2 * static_cast<std::uint64_t>(options_.side) * static_cast<std::uint64_t>(options_.side);
    }
    [[nodiscard]] std::uint64_t vertices() const { return triangles() / 2 + 2; }

    [[nodiscard]] Cost write_full() const {
        return in_child([this] {
            SpeedModel model = make_speed_model(options_.side);
            add_voxels(model, options_.cells);
            return cost_of([&] {
                const VoxelData voxels{model.shell,        model.solid,      model.reinforced,
                                       model.voxel_colors, model.stress_mpa, model.labels};
                CarvedPackage package;
                package.objects.push_back({model.mesh, model.colors, "ball", &voxels});
                write_carved_threemf(full(), package);
            });
        });
    }

    [[nodiscard]] Cost write_plain() const {
        return in_child([this] {
            const SpeedModel model = make_speed_model(options_.side);
            return cost_of([&] { write_mesh(plain(), {model.mesh}); });
        });
    }

    [[nodiscard]] Cost read_full() const {
        return in_child([this] {
            return cost_of([&] {
                const std::string bytes = read_file(full());
                const VolumetricFile file = read_threemf_with_volumes(bytes, "full.3mf");
                expect(file.mesh.mesh.triangles.size(), triangles(), "triangles");
                expect(file.mesh.triangle_colors.size(), triangles(), "colours");
                expect(file.objects.size(), 1, "objects with voxel data");
            });
        });
    }

    [[nodiscard]] Cost read_plain() const {
        return in_child([this] {
            return cost_of([&] { expect(read_mesh(plain()).mesh.triangles.size(), triangles(), "triangles"); });
        });
    }

#ifdef FRETWORK_LIB3MF
    [[nodiscard]] Cost lib3mf_writes() const {
        return in_child([this] {
            const TriangleMesh mesh = make_speed_model(options_.side).mesh;
            return cost_of([&] { lib3mf_write(scratch_.path() / "lib3mf.3mf", mesh); });
        });
    }

    [[nodiscard]] Cost lib3mf_reads(const fs::path& file) const {
        return in_child([&] { return cost_of([&] { expect(lib3mf_read(file), triangles(), "triangles"); }); });
    }
#endif

    [[nodiscard]] static Cost prusa(const std::vector<std::string>& arguments) {
        std::vector<std::string> command = {kPrusaSlicer};
        command.insert(command.end(), arguments.begin(), arguments.end());
        const ChildResult child = run_command(command);
        if (child.exit_code != 0) throw std::runtime_error("PrusaSlicer failed");
        return {child.seconds, child.cpu_seconds, child.peak_bytes};
    }

    /// What a run takes beyond another one. \param less  seconds are taken off, memory is not
    static Cost beyond(const Cost& run, const Cost& less) {
        return {run.seconds - less.seconds, run.cpu_seconds - less.cpu_seconds, run.peak_bytes};
    }

    [[nodiscard]] Cost prusa_reads(const fs::path& file) const {
        return beyond(prusa({"--info", file}), prusa({"--info", tiny()}));
    }

    [[nodiscard]] Cost prusa_writes() const {
        const fs::path out = scratch_.path() / "prusa.3mf";
        return beyond(prusa({"--export-3mf", "-o", out, plain()}), prusa({"--info", plain()}));
    }

    [[nodiscard]] static bool has_prusa() {
        return fs::exists(kPrusaSlicer);
    }

  private:
    static constexpr const char* kPrusaSlicer = "/usr/bin/prusa-slicer";

    const Options& options_;
    ScratchFolder scratch_;
};

enum class Direction { kWrite, kRead };

struct Row {
    std::string program, file;
    Direction direction;
    bool ours = false;
    std::function<Cost()> measure;
    std::optional<Cost> cost = {};
};

/// In the order in which files come to be.
std::vector<Row> rows_of(const Jobs& jobs) {
    const std::string full = "mesh, colours, voxel data", plain = "mesh";
    std::vector<Row> rows = {
        {"Fretwork", full, Direction::kWrite, true, [&] { return jobs.write_full(); }},
        {"Fretwork", plain, Direction::kWrite, true, [&] { return jobs.write_plain(); }},
        {"Fretwork", full, Direction::kRead, true, [&] { return jobs.read_full(); }},
        {"Fretwork", plain, Direction::kRead, true, [&] { return jobs.read_plain(); }},
    };
#ifdef FRETWORK_LIB3MF
    rows.push_back({"lib3mf", plain, Direction::kWrite, false, [&] { return jobs.lib3mf_writes(); }});
    rows.push_back({"lib3mf", full, Direction::kRead, false, [&] { return jobs.lib3mf_reads(jobs.full()); }});
    rows.push_back({"lib3mf", plain, Direction::kRead, false, [&] { return jobs.lib3mf_reads(jobs.plain()); }});
#endif
    if (Jobs::has_prusa()) {
        rows.push_back({"PrusaSlicer", plain, Direction::kWrite, false, [&] { return jobs.prusa_writes(); }});
        rows.push_back({"PrusaSlicer", full, Direction::kRead, false, [&] { return jobs.prusa_reads(jobs.full()); }});
        rows.push_back({"PrusaSlicer", plain, Direction::kRead, false, [&] { return jobs.prusa_reads(jobs.plain()); }});
    }
    return rows;
}

const char* word_of(Direction direction) {
    return direction == Direction::kWrite ? "write" : "read";
}

/// What the mesh itself takes, in bytes.
struct RawSize {
    double held = 0.0;    ///< as we hold it: doubles, 32-bit indices, colours
    double single = 0.0;  ///< single precision and no colours
};

RawSize raw_size(const Jobs& jobs) {
    const auto v = static_cast<double>(jobs.vertices()), t = static_cast<double>(jobs.triangles());
    return {v * sizeof(Vec3) + t * (sizeof(Triangle) + sizeof(Rgb8)), v * 3 * sizeof(float) + t * sizeof(Triangle)};
}

std::string cost_table(const std::vector<Row>& rows, const RawSize& raw) {
    MarkdownTable table(
        {"", "program", "file", "seconds", "CPU seconds", "peak MB", "peak / raw as held", "peak / raw single"});
    for (const Row& row : rows) {
        const auto peak = static_cast<double>(row.cost->peak_bytes);
        table.add({word_of(row.direction), row.program, row.file, fmt::format("{:.2f}", row.cost->seconds),
                   fmt::format("{:.2f}", row.cost->cpu_seconds), fmt::format("{:.0f}", 1e-6 * peak),
                   fmt::format("{:.1f}", peak / raw.held), fmt::format("{:.1f}", peak / raw.single)});
    }
    return table.text();
}

/// Ours against the fastest of the others with the mesh alone.
std::string promise_table(const std::vector<Row>& rows, const RawSize& raw) {
    MarkdownTable table({"", "file", "measure", "to stay below", "ours", "kept"});
    for (const Row& row : rows) {
        if (!row.ours) continue;
        const auto add = [&](const char* measure, double limit, double ours) {
            table.add({word_of(row.direction), row.file, measure, fmt::format("{:.2f}", limit),
                       fmt::format("{:.2f}", ours), ours < limit ? "yes" : "**no**"});
        };
        std::optional<Cost> others;
        for (const Row& other : rows)
            if (!other.ours && other.direction == row.direction)
                others = others ? least(*others, *other.cost) : *other.cost;
        if (others) {
            add("seconds", others->seconds, row.cost->seconds);
            add("CPU seconds", others->cpu_seconds, row.cost->cpu_seconds);
        }
        add("peak / raw as held", 4.0, static_cast<double>(row.cost->peak_bytes) / raw.held);
    }
    return table.text();
}

std::string report(const Options& options) {
    const Jobs jobs(options);
    std::vector<Row> rows = rows_of(jobs);
    // The others read what ours have written.
    std::erase_if(rows,
                  [&](const Row& row) { return !row.ours && row.program.find(options.only) == std::string::npos; });
    for (int repeat = 0; repeat < options.repeats; ++repeat)
        for (Row& row : rows) {
            const Cost cost = row.measure();
            row.cost = row.cost ? least(*row.cost, cost) : cost;
            fmt::print(stderr, "{} {}, {}: {:.2f} s, {:.2f} s CPU, {:.0f} MB\n", row.program, word_of(row.direction),
                       row.file, cost.seconds, cost.cpu_seconds, 1e-6 * static_cast<double>(cost.peak_bytes));
        }
    const RawSize raw = raw_size(jobs);
    return fmt::format(
               "{} triangles, {} vertices, voxel data at {}^3; {:.0f} MB with voxel data, {:.0f} MB without. The least "
               "of "
               "{} runs of each. Raw mesh: {:.0f} MB as held (three doubles a vertex, three 32-bit indices and a "
               "colour a triangle), {:.0f} MB in single precision without colours.\n\n",
               jobs.triangles(), jobs.vertices(), options.cells, 1e-6 * static_cast<double>(fs::file_size(jobs.full())),
               1e-6 * static_cast<double>(fs::file_size(jobs.plain())), options.repeats, 1e-6 * raw.held,
               1e-6 * raw.single) +
           cost_table(rows, raw) + "\n" + promise_table(rows, raw);
}

}  // namespace

int main(int argc, char** argv) {
    Options options;
    CLI::App app("Speed and memory of 3MF readers and writers");
    app.add_option("--side", options.side, "the model has twice the square of this many triangles")
        ->check(CLI::Range(4, 4000));
    app.add_option("--cells", options.cells, "voxels along each side of the grid")->check(CLI::Range(4, 512));
    app.add_option("--repeats", options.repeats, "runs of each, of which the least counts")->check(CLI::Range(1, 100));
    app.add_option("--only", options.only, "of the other programs, those whose name holds this");
    app.add_option("--write", options.document, "document whose section 'threemf' is replaced");
    CLI11_PARSE(app, argc, argv);
    return publish("threemf_speed", options.document, "threemf", [&] { return report(options); });
}
