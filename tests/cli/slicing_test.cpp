// From a model to G-code: what `carve` writes goes through the real PrusaSlicer without repair.
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>

#include "cli/run_program.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"

namespace fretwork::testing {
namespace {

bool slicer_is_there() {
    if (std::system("command -v prusa-slicer > /dev/null 2>&1") == 0) return true;
    WARN("prusa-slicer is not installed: skipped");
    return false;
}

std::string slicer_says(const std::string& arguments) {
    const std::string command = "timeout 110 prusa-slicer " + arguments + " 2>&1";
    FILE* pipe = ::popen(command.c_str(), "r");
    REQUIRE(pipe != nullptr);
    std::string text;
    char block[4096];
    for (std::size_t got = 0; (got = std::fread(block, 1, sizeof block, pipe)) > 0;) text.append(block, got);
    CAPTURE(text);
    CHECK(::pclose(pipe) == 0);
    return text;
}

void carve_and_slice(const TemporaryFolder& folder, const std::string& model, const std::string& pattern,
                     const std::string& size_mm) {
    const std::string carved = folder / "carved.3mf";
    const ProgramResult run =
        run_program({"carve", model, "--pattern", pattern, "--size-mm", size_mm, "--resolution", "96", "-o", carved});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);

    const std::string info = slicer_says("--info " + carved);
    CAPTURE(info);
    CHECK(info.find("manifold = yes") != info.npos);
    CHECK(info.find("number_of_parts =  1") != info.npos);
    CHECK(info.find("facets_reversed") == info.npos);
    CHECK(info.find("open_edges") == info.npos);
    CHECK(info.find("edges_fixed") == info.npos);

    const std::string code = folder / "carved.gcode";
    const std::string sliced =
        slicer_says("-g -o " + code + " --layer-height 0.3 --fill-density 0 --support-material " + carved);
    CHECK(sliced.find("Slicing result exported") != sliced.npos);
    CHECK(sliced.find("Empty layer") == sliced.npos);
    const std::string text = slurp(code);
    std::size_t layers = 0;
    for (std::size_t at = text.find(";LAYER_CHANGE"); at != text.npos; at = text.find(";LAYER_CHANGE", at + 1))
        ++layers;
    CHECK(layers > 50);
}

TEST_CASE("a carved vase slices in PrusaSlicer: manifold, one part, no repair", "[cli][programs]") {
    if (!slicer_is_there()) return;
    const TemporaryFolder folder;
    write_mesh(std::filesystem::path(folder / "vase.stl"), {make_vase(40.0)});
    carve_and_slice(folder, folder / "vase.stl", "waves", "40");
}

TEST_CASE("a carved bracket slices in PrusaSlicer: manifold, one part, no repair", "[cli][programs]") {
    if (!slicer_is_there()) return;
    const TemporaryFolder folder;
    write_mesh(std::filesystem::path(folder / "bracket.stl"), {make_bracket()});
    carve_and_slice(folder, folder / "bracket.stl", "hexagons", "48");
}

TEST_CASE("a carved bunny slices in PrusaSlicer: manifold, one part, no repair", "[cli][programs]") {
    if (!slicer_is_there()) return;
    const std::string bunny = "/usr/share/PrusaSlicer/shapes/bunny.stl";
    if (!std::filesystem::exists(bunny)) {
        WARN(bunny << " is not there: skipped");
        return;
    }
    const TemporaryFolder folder;
    carve_and_slice(folder, bunny, "cells", "50");
}

const std::string kProfiles = FRETWORK_REPOSITORY "/examples/profiles/";

ProgramResult carve_with(const TemporaryFolder& folder, const std::string& profile,
                         std::vector<std::string> more = {}) {
    write_mesh(std::filesystem::path(folder / "vase.stl"), {make_vase(30.0)});
    std::vector<std::string> line = {"carve",     folder / "vase.stl", "--pattern", "bubbles", "--resolution",
                                     "64",        "--slice",           profile,     "-o",      folder / "vase.3mf",
                                     "--summary", folder / "vase.json"};
    line.insert(line.end(), more.begin(), more.end());
    return run_program(line);
}

TEST_CASE("slice: goes on to G-code, with what it takes and what is wrong with it in the report", "[cli][programs]") {
    if (!slicer_is_there()) return;
    const TemporaryFolder folder;
    const ProgramResult run = carve_with(folder, kProfiles + "fdm-0.4.ini", {"-d", folder / "vase.d"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    CHECK(slurp(folder / "vase.gcode").find(";LAYER_CHANGE") != std::string::npos);
    CHECK(slurp(folder / "vase.d").find("fdm-0.4.ini") != std::string::npos);
    const auto report = nlohmann::json::parse(slurp(folder / "vase.json"));
    const auto& slicing = report["slicing"];
    CHECK(slicing["slicer"] == "prusa-slicer");
    CHECK(slicing["parts_compared"] == true);
    CHECK(slicing["lost_parts"] == 0);
    CHECK(slicing["faults"].empty());
    CHECK(slicing["seconds"].get<double>() > 600.0);
    CHECK(slicing["filament_g"].get<double>() > 1.0);
    // Both count the same layers of the same body; supports come on top.
    CHECK(slicing["layers"] == report["printability"]["layers"]);
    CHECK(slicing["material_ml"].get<double>() * 1000 > 0.6 * report["printability"]["material_mm3"].get<double>());
}

TEST_CASE("slice: what the printer cannot reach or the slicer will not do is told", "[cli][programs][errors]") {
    if (!slicer_is_there()) return;
    const TemporaryFolder folder;
    // Strong enough for any load: what remains is up to the slicer.
    const std::vector<std::string> strict = {"--strict", "--preset", "draft", "-D", "structure.strength_mpa=5000"};
    const ProgramResult fits = carve_with(folder, kProfiles + "fdm-0.4.ini", strict);
    CAPTURE(fits.err);
    CHECK(fits.exit_code == 0);
    const auto with = [&](const std::string& name, const std::string& from, const std::string& to) {
        std::string text = slurp(kProfiles + "fdm-0.4.ini");
        text.replace(text.find(from), from.size(), to);
        spit(folder / name, text);
        return carve_with(folder, folder / name, strict);
    };
    const ProgramResult low = with("low.ini", "max_print_height = 250", "max_print_height = 20");
    CAPTURE(low.err);
    CHECK(low.exit_code == 4);
    CHECK(low.err.find("and 20 mm high") != std::string::npos);
    const ProgramResult tiny = with("tiny.ini", "0x0,220x0,220x220,0x220", "0x0,5x0,5x5,0x5");
    CAPTURE(tiny.err);
    CHECK(tiny.exit_code == 2);
    CHECK(tiny.err.find("tiny.ini") != std::string::npos);
    // Whatever the slicer says, the carved model is there, and what the run found out.
    CHECK(std::filesystem::exists(folder / "vase.3mf"));
    CHECK_FALSE(nlohmann::json::parse(slurp(folder / "vase.json")).contains("slicing"));

    CHECK(carve_with(folder, folder / "no.ini").exit_code == 2);
    CHECK(carve_with(folder, folder / "profile.txt").exit_code == 1);
    CHECK(run_program({"carve", folder / "vase.stl", "--pattern", "cells", "-o", "-", "--export-format", "stl",
                       "--slice", kProfiles + "fdm-0.4.ini"})
              .exit_code == 1);
}

TEST_CASE("slice: resin and powder become pictures of their layers", "[cli][programs]") {
    if (!slicer_is_there()) return;
    const TemporaryFolder folder;
    const ProgramResult run = carve_with(folder, kProfiles + "powder.ini", {"--preset", "draft"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    const auto slicing = nlohmann::json::parse(slurp(folder / "vase.json"))["slicing"];
    CHECK(slicing["layers"].get<int>() == Approx(300).margin(20));
    CHECK(slicing["faults"].empty());
    CHECK(slicing["material_ml"].get<double>() > 0.1);
    CHECK(std::filesystem::file_size(folder / "vase.sl1") > 10000);
}

TEST_CASE("slice: a definition goes to CuraEngine", "[cli][programs]") {
    if (std::system("command -v CuraEngine > /dev/null 2>&1") != 0) {
        WARN("CuraEngine is not installed: skipped");
        return;
    }
    const TemporaryFolder folder;
    // One that builds on the example, as definitions of printers do.
    std::filesystem::copy(kProfiles + "cura-0.4.def.json", std::filesystem::path(folder / "cura-0.4.def.json"));
    const auto printer = [&](const std::string& name, int height_mm) {
        spit(folder / (name + ".def.json"),
             R"({"version": 2, "name": "Small", "inherits": "cura-0.4", "overrides": {"machine_height": )"
             R"({"default_value": )" +
                 std::to_string(height_mm) + "}}}");
        return folder / (name + ".def.json");
    };
    const std::vector<std::string> strict = {"--strict", "--preset",       "draft", "-D", "structure.strength_mpa=5000",
                                             "-d",       folder / "vase.d"};
    const ProgramResult run = carve_with(folder, printer("tall", 60), strict);
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    for (const char* name : {"tall.def.json", "cura-0.4.def.json"})
        CHECK(slurp(folder / "vase.d").find(folder / name) != std::string::npos);
    CHECK(slurp(folder / "vase.gcode").find(";LAYER:") != std::string::npos);
    const auto slicing = nlohmann::json::parse(slurp(folder / "vase.json"))["slicing"];
    CHECK(slicing["slicer"] == "CuraEngine");
    CHECK(slicing["layers"].get<int>() == Approx(150).margin(2));
    CHECK(slicing["seconds"].get<double>() > 600.0);
    CHECK(slicing["parts_compared"] == true);
    CHECK(slicing["faults"].empty());
    const double filament_mm3 = slicing["filament_mm"].get<double>() * 1.75 * 1.75 * std::numbers::pi / 4.0;
    CHECK(slicing["material_ml"].get<double>() * 1000.0 == Approx(filament_mm3).epsilon(0.02));
    CHECK(filament_mm3 > 500.0);

    const ProgramResult low = carve_with(folder, printer("low", 20), strict);
    CAPTURE(low.err);
    CHECK(low.exit_code == 4);
    CHECK(low.err.find("and 20 mm high") != std::string::npos);
    const ProgramResult check = carve_with(folder, printer("low", 20), {"--check"});
    CHECK_THAT(check.err, Catch::Contains("reaches 220 x 220 x 20 mm"));
    spit(folder / "broken.def.json", "{\"overrides\": ");
    const ProgramResult broken = carve_with(folder, folder / "broken.def.json", {"--check"});
    CHECK(broken.exit_code == 2);
    CHECK_THAT(broken.err, Catch::Contains("broken.def.json"));
}

}  // namespace
}  // namespace fretwork::testing
