// From a model to G-code: what `carve` writes goes through the real PrusaSlicer without repair.
#include <catch2/catch.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

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

}  // namespace
}  // namespace fretwork::testing
