// OpenSCAD files go in as they are, through the real OpenSCAD.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli/run_program.h"
#include "core/mesh/closest_point.h"
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
    // What is there renders without what is not, with an exit code of 0.
    refused("cube(20); import(\"nowhere.stl\");", "nowhere.stl");
    refused("use <nolib.scad>\ncube(20);", "nolib.scad");
    refused("include <nofile.scad>\ncube(20);", "nofile.scad");
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

const std::vector<std::string> kQuick = {
    "--pattern", "hexagons", "--resolution", "48", "-D", "structure.max_iterations=2", "--quiet"};

ProgramResult carve_quickly(const std::string& part, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"carve", part};
    arguments.insert(arguments.end(), kQuick.begin(), kQuick.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_program(arguments);
}

TEST_CASE("openscad: -D may name what an included file assigns, and nothing that none does",
          "[cli][programs][errors]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    spit(folder / "deep.scad", "wide = 20;\n");
    spit(folder / "sizes.scad", "include <deep.scad>\nlong = 30;\n");
    spit(folder / "tools.scad", "high = 9;\nfunction tall() = 40;\n");
    spit(folder / "part.scad", "include <sizes.scad>\nuse <tools.scad>\ncube([wide, long, tall()]);\n");
    const auto carved = [&](const std::string& define) {
        return carve_quickly(folder / "part.scad", {"-D", define, "--width-mm", "10", "-o", folder / "out.stl"});
    };
    const ProgramResult result = carved("wide=25");
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    CHECK(result.err.empty());
    const MeshReport mesh = report_mesh(read_mesh(std::filesystem::path(folder / "out.stl")).mesh);
    CHECK(mesh.max_mm[0] - mesh.min_mm[0] == Approx(25.0).margin(kSlackMm));
    for (const std::string define : {"wied=25", "high=25"}) {
        const ProgramResult unknown = carved(define);
        CHECK(unknown.exit_code == 1);
        CHECK_THAT(unknown.err, Catch::Contains(define));
    }
}

TEST_CASE("openscad: a part may come from standard input", "[cli][programs]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    const std::string part =
        "/* fretwork\n[exemplar]\npattern = \"hexagons\"\nwidth_mm = 10\n[shell]\nresolution = 48\n"
        "[structure]\nmax_iterations = 2\n*/\nsize = 20;\ncube(size);\n";
    spit(folder / "part.scad", part);
    const auto carve = [&](const std::string& in, std::vector<std::string> more) {
        std::vector<std::string> line = {"carve",       in,   "-D", "size=24",         "--quiet",
                                         "--no-source", "-o", "-",  "--export-format", "stl"};
        line.insert(line.end(), more.begin(), more.end());
        return run_program(line, in == "-" ? part : "");
    };
    const ProgramResult file = carve(folder / "part.scad", {}), stream = carve("-", {"--input-format", "scad"});
    CAPTURE(file.err, stream.err);
    REQUIRE(file.exit_code == 0);
    REQUIRE(stream.exit_code == 0);
    CHECK(file.out.size() > 10000);
    CHECK(stream.out == file.out);
    const ProgramResult broken = run_program({"carve", "-", "--input-format", "scad", "-o", folder / "x.stl"}, "cube(");
    CHECK(broken.exit_code == 2);
    CHECK_THAT(broken.err, Catch::Contains("standard input"));
}

/// A plate that stands, with marks on it.
const std::string kMarked =
    "use <fretwork.scad>\n"
    "fretwork_body() cube([60, 8, 60]);\n"
    "fretwork_keep(\"foot\") translate([-1, -1, -1]) cube([62, 10, 13]);\n"
    "fretwork_keep(\"hole\") translate([30, -1, 30]) rotate([-90, 0, 0]) cylinder(r = 9, h = 10, $fn = 32);\n"
    "fretwork_load(\"top\", force_n = [0, 0, -25.5], case = \"press\") translate([0, 0, 55]) cube([60, 8, 9]);\n"
    "fretwork_fixture() translate([0, 0, -2]) cube([60, 8, 2]);\n";

TEST_CASE("openscad: modules of fretwork.scad mark what is kept, pushed and held", "[cli][programs]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    spit(folder / "part.scad", kMarked);
    const ProgramResult result = carve_quickly(
        folder / "part.scad", {"-o", folder / "part.3mf", "--summary", folder / "part.json", "-d", folder / "part.d"});
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    const Json settings = Json::parse(slurp(folder / "part.json"))["settings"];
    REQUIRE(settings["keep"].size() == 2);
    CHECK(settings["keep"][0]["name"] == "foot");
    CHECK(settings["keep"][0]["shape"] == "volume");
    CHECK(settings["loads"][0]["name"] == "top");
    CHECK(settings["loads"][0]["case"] == "press");
    CHECK(settings["loads"][0]["force_n"] == Json({0.0, 0.0, -25.5}));
    CHECK(settings["fixtures"][0]["name"] == "fixture");

    // The part is the body alone, solid in the foot and in the disc, and carved elsewhere.
    const MeshFile carved = read_mesh(std::filesystem::path(folder / "part.3mf"));
    const MeshReport report = report_mesh(carved.mesh);
    CHECK(report.closed_manifold());
    CHECK(report.max_mm[2] - report.min_mm[2] == Approx(60.0).margin(kSlackMm));
    const SurfaceTree tree(carved.mesh);
    const auto share_solid = [&](const Vec3& from, const Vec3& to) {
        int solid = 0, all = 0;
        for (double x = from[0]; x <= to[0]; x += 1.0)
            for (double z = from[2]; z <= to[2]; z += 1.0, ++all)
                solid += tree.first_hit(Vec3(x, -5, z), Vec3(x, 0.7, z)).has_value() ? 1 : 0;
        return static_cast<double>(solid) / all;
    };
    CHECK(share_solid(Vec3(2, 0, 2), Vec3(58, 0, 11)) == 1.0);
    CHECK(share_solid(Vec3(25, 0, 25), Vec3(35, 0, 35)) == 1.0);
    CHECK(share_solid(Vec3(5, 0, 42), Vec3(55, 0, 57)) < 0.9);
    // What the library is written to for OpenSCAD is gone by now and nothing to wait for.
    CHECK(slurp(folder / "part.d").find("fretwork.scad") == std::string::npos);

    const ProgramResult again = run_program({"carve", folder / "part.3mf", "--again", "-o", folder / "again.3mf"});
    CAPTURE(again.err);
    REQUIRE(again.exit_code == 0);
    CHECK((slurp(folder / "again.3mf") == slurp(folder / "part.3mf")));
}

TEST_CASE("openscad: marks that cannot be meant are refused by name", "[cli][programs][errors]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    const auto refused = [&](const std::string& marks, int code, const std::string& expected) {
        spit(folder / "part.scad", "use <fretwork.scad>\nfretwork_body() cube(40);\n" + marks);
        const ProgramResult result = carve_quickly(folder / "part.scad", {"-o", folder / "part.stl"});
        CAPTURE(marks, result.err);
        CHECK(result.exit_code == code);
        CHECK(result.err.find(expected) != std::string::npos);
        CHECK(folder.names() == std::vector<std::string>{"part.scad"});
    };
    refused("fretwork_keep(\"far\") translate([90, 0, 0]) cube(9);", 1, "'far': meets no part of the surface");
    refused("fretwork_keep(\"none\") square(0);", 2, "fretwork_keep(\"none\")");
    refused("fretwork_keep(\"top lid\") cube(9);", 2, "expected text of letters, digits, _ and -");
    refused("fretwork_load(\"hand\") cube(9);", 2, "needs force_n or pressure_mpa");
    refused("fretwork_load(\"hand\", force_n = 5) cube(9);", 2, "expected three numbers");
    refused("fretwork_keep() cube(9); sphere(50);", 2, "outside of fretwork_body()");
    refused("fretwork_fixture(\"a\", case = \"x\") cube(9); fretwork_fixture(\"a\", case = \"y\") cube(9);", 1,
            "fretwork_fixture(\"a\") says");
}

TEST_CASE("openscad: without Fretwork a marked part is just the part", "[cli][programs]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    spit(folder / "part.scad", kMarked);
    const std::string library = FRETWORK_REPOSITORY "/cli/openscad";
    const std::string render = "OPENSCADPATH='" + library + "' openscad -q -o '" + (folder / "part.off") + "' '" +
                               (folder / "part.scad") + "'";
    REQUIRE(std::system(render.c_str()) == 0);
    CHECK(report_mesh(read_mesh(std::filesystem::path(folder / "part.off")).mesh).max_mm == Vec3(60, 8, 60));
}

/// What one line of OpenSCAD makes of the files in the folder.
MeshReport rendered(const TemporaryFolder& folder, const std::string& line) {
    spit(folder / "cut.scad", line + "\n");
    const std::string made = folder / "cut.off";
    std::filesystem::remove(made);
    const std::string run =
        "openscad -o '" + made + "' '" + (folder / "cut.scad") + "' > '" + (folder / "log") + "' 2>&1";
    const int status = std::system(run.c_str());
    const std::string log = slurp(folder / "log");
    CAPTURE(line, log);
    REQUIRE(status == 0);
    CHECK(log.find("ERROR") == std::string::npos);
    CHECK(log.find("WARNING") == std::string::npos);
    return report_mesh(read_mesh(std::filesystem::path(made)).mesh);
}

TEST_CASE("openscad: carved models can be imported and cut, in every format that it reads", "[cli][programs]") {
    if (openscad_is_missing()) return;
    const TemporaryFolder folder;
    spit(folder / "part.scad", "cylinder(r1 = 20, r2 = 12, h = 50, $fn = 48);\n");
    const auto* const format = GENERATE("stl", "off", "amf", "3mf");
    const std::string name = std::string("carved.") + format;
    CAPTURE(name);
    const ProgramResult result = carve_quickly(
        folder / "part.scad", {"-D", "fabrication.target_triangles=4000", "--width-mm", "30", "-o", folder / name});
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    const MeshReport whole = report_mesh(read_mesh(std::filesystem::path(folder / name)).mesh);
    CHECK(whole.triangles <= 4000);
    // Cut in two, through pattern and shell: nothing is lost and nothing is closed up.
    const std::string model = "import(\"" + name + "\"); ", half = "translate([-30, -30, -5]) cube([60, 60, 29.7]);";
    const MeshReport low = rendered(folder, "intersection() { " + model + half + " }");
    const MeshReport high = rendered(folder, "difference() { " + model + half + " }");
    CHECK(low.volume_mm3 > 0.2 * whole.volume_mm3);
    CHECK(high.volume_mm3 > 0.2 * whole.volume_mm3);
    CHECK(low.volume_mm3 + high.volume_mm3 == Approx(whole.volume_mm3).epsilon(1e-4));
    CHECK(low.max_mm[2] == Approx(24.7).margin(1e-3));
    CHECK(high.min_mm[2] == Approx(24.7).margin(1e-3));
}

}  // namespace
}  // namespace fretwork
