// The numbered examples do what they say, and the README shows every one of them.
#include <sys/wait.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/run_program.h"
#include "core/mesh/mesh_report.h"
#include "formats/image_file.h"
#include "formats/mesh_file.h"

namespace fretwork::testing {
namespace {

namespace fs = std::filesystem;
const fs::path kExamples = fs::path(FRETWORK_REPOSITORY) / "examples";

/// Names without extension of the numbered files that end like this, sorted.
std::vector<std::string> numbered(const std::string& extension) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(kExamples)) {
        const std::string name = entry.path().stem().string();
        if (entry.path().extension() == extension && name.size() > 3 && std::isdigit(name[0]) != 0)
            names.push_back(name);
    }
    std::ranges::sort(names);
    return names;
}

/// Exit code of a line of shell; what it says goes to OUT/log.
int shell(const TemporaryFolder& out, const std::string& line) {
    const int status = std::system((line + " > '" + (out / "log") + "' 2>&1").c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

/// False where the example was skipped because a program is not installed.
bool run_example(const TemporaryFolder& out, const std::string& name) {
    const std::string script = (kExamples / (name + ".sh")).string();
    const int code =
        shell(out, "OUT='" + (out / "") + "' FRETWORK='" FRETWORK_PROGRAM "' RESOLUTION=56 bash '" + script + "'");
    const std::string log = slurp(out / "log");
    CAPTURE(log);
    if (code == 77) {
        CHECK(log.find(" is not installed") != std::string::npos);
        WARN(name << ": " << log);
        return false;
    }
    REQUIRE(code == 0);
    return true;
}

void check_carved(const std::string& file) {
    CAPTURE(file);
    const MeshFile carved = read_mesh(fs::path(file));
    const MeshReport report = report_mesh(carved.mesh, CountSelfIntersections::kYes);
    CHECK(report.closed_manifold());
    CHECK(report.components == 1);
    CHECK(report.self_intersections == 0);
    CHECK(carved.triangle_colors.size() == carved.mesh.triangles.size());
}

TEST_CASE("examples: every numbered script runs and makes valid models", "[cli][examples]") {
    const std::string name = GENERATE(from_range(numbered(".sh")));
    CAPTURE(name);
    const TemporaryFolder out;
    if (!run_example(out, name)) return;
    int models = 0;
    for (const std::string& file : out.names()) {
        if (!file.ends_with(".3mf")) continue;
        CHECK(file.starts_with(name.substr(0, 3)));
        check_carved(out / file);
        ++models;
    }
    CHECK(models >= 1);
    if (name == "04_loads") {
        const auto summary = nlohmann::json::parse(slurp(out / "04_loads.json"));
        CHECK(summary["structure"]["allowable_pa"].get<double>() > 0.0);
        CHECK(summary["settings"]["structure"]["material"] == "PETG");
    }
    if (name == "05_orientation") {
        CHECK(models == 3);
        CHECK(slurp(out / "05_orientation_up.3mf") != slurp(out / "05_orientation_free.3mf"));
        CHECK(slurp(out / "05_orientation_up.3mf") != slurp(out / "05_orientation_vector.3mf"));
    }
    if (name == "13_rough_use") {
        const auto verified = nlohmann::json::parse(slurp(out / "13_strength.json"));
        std::vector<std::string> cases;
        for (const auto& found : verified["strength"]["cases"]) cases.push_back(found["name"].get<std::string>());
        REQUIRE(cases.size() > 10);
        CHECK(cases[0] == "gravity");
        CHECK(cases[1] == "drop");
        CHECK(cases[2].starts_with("grip at"));
        CHECK(cases.back().starts_with("worst case at"));
    }
    if (name == "12_marks") CHECK(slurp(out / "12_marks.gcode").find(";LAYER_CHANGE") != std::string::npos);
    if (name == "11_slice")
        CHECK(nlohmann::json::parse(slurp(out / "11_slice.json"))["slicing"]["layers"].get<int>() > 100);
    if (name == "11_slice") CHECK(slurp(out / "11_slice.gcode").find(";LAYER_CHANGE") != std::string::npos);
}

TEST_CASE("examples: make carves again only what changed", "[cli][examples]") {
    const TemporaryFolder out;
    if (!run_example(out, "10_make")) return;
    const auto made = fs::last_write_time(out / "10_scales.3mf");
    const auto others = fs::last_write_time(out / "10_leafveins.3mf");
    fs::remove(out / "10_leafveins.3mf");
    REQUIRE(run_example(out, "10_make"));
    CHECK(fs::last_write_time(out / "10_scales.3mf") == made);
    CHECK(fs::last_write_time(out / "10_leafveins.3mf") > others);
    CHECK(slurp(out / "10_scales.d").find("10_sets.json") != std::string::npos);
}

TEST_CASE("examples: a set of OpenSCAD parts is made once, and again when its picture changes", "[cli][examples]") {
    if (shell(TemporaryFolder(), "command -v openscad && command -v make") != 0) {
        WARN("openscad or make is not installed: skipped");
        return;
    }
    const TemporaryFolder folder;
    fs::copy(kExamples / "openscad", fs::path(folder / "openscad"));
    fs::copy(kExamples / "02_leaves.png", fs::path(folder / "02_leaves.png"));
    const std::vector<std::string> sets = {"small", "tall", "square"};
    const auto make = [&] {
        const int code = shell(
            folder, "make -C '" + (folder / "openscad") + "' FRETWORK='" FRETWORK_PROGRAM "' OUT=out RESOLUTION=56");
        INFO(slurp(folder / "log"));
        REQUIRE(code == 0);
        std::vector<fs::file_time_type> times;
        for (const std::string& set : sets)
            times.push_back(fs::last_write_time(fs::path(folder / "openscad") / "out" / (set + ".3mf")));
        return times;
    };
    const auto first = make();
    for (const std::string& set : sets) check_carved(folder / ("openscad/out/" + set + ".3mf"));
    CHECK(make() == first);
    const fs::path picture = folder / "02_leaves.png";
    fs::last_write_time(picture, fs::file_time_type::clock::now());
    const auto second = make();
    for (std::size_t i = 0; i < sets.size(); ++i) CHECK(second[i] > first[i]);
}

#ifdef FRETWORK_EXAMPLE_LIBRARY
TEST_CASE("examples: the program that uses the library carves its ring", "[cli][examples]") {
    const TemporaryFolder out;
    REQUIRE(shell(out, "'" FRETWORK_EXAMPLE_LIBRARY "' '" + (out / "08_library.3mf") + "' 48") == 0);
    CHECK(slurp(out / "log").find("% solid") != std::string::npos);
    check_carved(out / "08_library.3mf");
    CHECK(shell(out, "'" FRETWORK_EXAMPLE_LIBRARY "'") == 1);
    CHECK(shell(out, "'" FRETWORK_EXAMPLE_LIBRARY "' '" + (out / "no/where.3mf") + "' 48") == 2);
}
#endif

TEST_CASE("examples: specs are valid, and the gallery in the README shows them all", "[cli][examples]") {
    const TemporaryFolder folder;
    for (const auto& entry : fs::directory_iterator(kExamples))
        if (entry.path().extension() == ".toml") {
            CAPTURE(entry.path());
            CHECK(run_program({"spec", "check", entry.path().string()}).exit_code == 0);
        }
    const std::string readme = slurp(FRETWORK_REPOSITORY "/README.md");
    std::vector<std::string> names = numbered(".sh");
    for (const std::string& program : numbered(".cpp")) names.push_back(program);
    CHECK(names.size() >= 11);
    for (const std::string& name : names) {
        CAPTURE(name);
        CHECK(readme.find("examples/" + name) != std::string::npos);
        const std::string picture = "docs/images/" + name + ".png";
        CHECK(readme.find(picture) != std::string::npos);
        const fs::path file = fs::path(FRETWORK_REPOSITORY) / picture;
        REQUIRE(fs::exists(file));
        CHECK(fs::file_size(file) <= 250'000);
        CHECK(read_image(file).width >= 300);
    }
}

}  // namespace
}  // namespace fretwork::testing
