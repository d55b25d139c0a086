// OpenSCAD files go in as they are, through the real OpenSCAD.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli/run_program.h"
#include "core/mesh/mesh_report.h"
#include "formats/mesh_file.h"

namespace fretwork {
namespace {

using Json = nlohmann::json;
using testing::ProgramResult;
using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

bool openscad_is_missing() {
    if (std::system("command -v openscad > /dev/null 2>&1") == 0) return false;
    WARN("openscad is not installed: skipped");
    return true;
}

/// Simplification may leave the surface by a third of a voxel, and voxels are over a millimetre here.
constexpr double kSlackMm = 0.4;

const std::string kPart =
    "/* fretwork\n[exemplar]\npattern = \"hexagons\"\nwidth_mm = 24\n[shell]\nthickness_mm = 5.0\nresolution = 32\n"
    "[synthesis]\npreset = \"draft\"\n[structure]\nmax_iterations = 2\nsamples = 100\n*/\n"
    "use <size.scad>\nradius = 12; // [5:30]\nheight = 30;\n$fn = 32;\ncylinder(r = radius, h = tall(height));\n";

void write_part(const TemporaryFolder& folder) {
    spit(folder / "part.scad", kPart);
    spit(folder / "size.scad", "function tall(h) = h;\n");
}

TEST_CASE("openscad: one file describes part and pattern, flags change both", "[cli][programs]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    write_part(folder);
    const ProgramResult result =
        run_program({"carve", folder / "part.scad", "-D", "radius=8", "-D", "shell.thickness_mm=4.5", "-o",
                     folder / "part.3mf", "--summary", folder / "part.json", "-d", folder / "part.d"});
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    const Json summary = Json::parse(slurp(folder / "part.json"));
    CHECK(summary["settings"]["exemplar"]["pattern"] == "hexagons");
    CHECK(summary["settings"]["shell"]["thickness_mm"] == 4.5);
    const MeshReport report = report_mesh(read_mesh(std::filesystem::path(folder / "part.3mf")).mesh);
    CHECK(report.closed_manifold());
    CHECK(report.max_mm[0] - report.min_mm[0] == Approx(16.0).margin(kSlackMm));
    CHECK(report.max_mm[2] - report.min_mm[2] == Approx(30.0).margin(kSlackMm));
    const std::string rule = slurp(folder / "part.d");
    CHECK(rule.find("part.scad") != std::string::npos);
    CHECK(rule.find("size.scad") != std::string::npos);

    // The package keeps what OpenSCAD has made of the file, so that it repeats without either.
    const ProgramResult again = run_program({"carve", folder / "part.3mf", "--again", "-o", folder / "again.3mf"});
    CAPTURE(again.err);
    REQUIRE(again.exit_code == 0);
    CHECK((slurp(folder / "again.3mf") == slurp(folder / "part.3mf")));
}

TEST_CASE("openscad: a parameter set speaks to the part and to the pattern", "[cli][programs]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    write_part(folder);
    spit(folder / "sets.json", R"({"parameterSets": {"tall": {"height": "40", "synthesis.seed": "7"},
                                   "typo": {"heigth": "40"}}, "fileFormatVersion": "1"})");
    const auto carve = [&](const std::string& set) {
        return run_program({"carve", folder / "part.scad", "-p", folder / "sets.json", "-P", set, "-o",
                            folder / "part.stl", "--summary", folder / "part.json"});
    };
    const ProgramResult tall = carve("tall");
    CAPTURE(tall.err);
    REQUIRE(tall.exit_code == 0);
    CHECK(Json::parse(slurp(folder / "part.json"))["seed"] == 7);
    const MeshReport report = report_mesh(read_mesh(std::filesystem::path(folder / "part.stl")).mesh);
    CHECK(report.max_mm[2] - report.min_mm[2] == Approx(40.0).margin(kSlackMm));
    const ProgramResult typo = carve("typo");
    CHECK(typo.exit_code == 1);
    CHECK(typo.err.find("heigth") != std::string::npos);
    CHECK(carve("short").exit_code == 1);
}

TEST_CASE("openscad: errors that OpenSCAD passes over in silence end the run", "[cli][programs][errors]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    const auto refused = [&](const std::string& text, const std::string& expected) {
        spit(folder / "bad.scad", text);
        const ProgramResult result =
            run_program({"carve", folder / "bad.scad", "--pattern", "cells", "-o", folder / "bad.stl"});
        CAPTURE(text, result.err);
        CHECK(result.exit_code == 2);
        CHECK(result.err.find("bad.scad") != std::string::npos);
        CHECK(result.err.find(expected) != std::string::npos);
        CHECK(folder.names() == std::vector<std::string>{"bad.scad"});
    };
    refused("cube(;", "ERROR");
    refused("assert(false); cube(1);", "ERROR");
    refused("x = 1;", "empty");
    refused("square(3);", "bad.scad");
    refused("import(\"nowhere.stl\");", "bad.scad");
    // A surface with a hole in it is dropped by a difference, with an exit code of 0.
    refused(
        "difference() { polyhedron(points=[[0,0,0],[9,0,0],[0,9,0],[0,0,9]], faces=[[0,1,2],[0,3,1],[0,2,3]]); "
        "translate([1,1,1]) cube(1); }",
        "bad.scad");
}

TEST_CASE("openscad: what OpenSCAD warns of is passed on, and other commands read the file too", "[cli][programs]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    spit(folder / "part.scad", "cube([20, 30, 40]); sphere(r = size);\n");
    const ProgramResult result = run_program({"convert", folder / "part.scad", folder / "part.stl"});
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    CHECK(result.err.find("size") != std::string::npos);
    CHECK(report_mesh(read_mesh(std::filesystem::path(folder / "part.stl")).mesh).max_mm == Vec3(20, 30, 40));
}

}  // namespace
}  // namespace fretwork
