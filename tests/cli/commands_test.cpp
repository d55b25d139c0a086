#include <signal.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <chrono>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "cli/run_program.h"
#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/mesh/mesh_report.h"
#include "formats/image_file.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using Json = nlohmann::json;
using testing::ProgramResult;
using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

std::string vase_off() {
    const TriangleMesh vase = testing::make_vase(50.0, 32, 16);
    return write_mesh({vase}, MeshFormat::kOff);
}

const std::vector<std::string> kQuick = {"--preset",     "draft",
                                         "--resolution", "32",
                                         "--width-mm",   "48",
                                         "-D",           "structure.max_iterations=2",
                                         "-D",           "structure.samples=100"};

std::vector<std::string> carve_line(const std::vector<std::string>& more) {
    std::vector<std::string> line = {"carve"};
    line.insert(line.end(), more.begin(), more.end());
    line.insert(line.end(), kQuick.begin(), kQuick.end());
    return line;
}

TEST_CASE("cli: help and version go to stdout and exit with 0", "[cli]") {
    const auto line = GENERATE(values<std::vector<std::string>>({{"-h"},
                                                                 {"--version"},
                                                                 {"carve", "-h"},
                                                                 {"convert", "-h"},
                                                                 {"info", "-h"},
                                                                 {"pattern", "-h"},
                                                                 {"pattern", "list", "-h"},
                                                                 {"pattern", "show", "-h"},
                                                                 {"pattern", "preview", "-h"},
                                                                 {"spec", "-h"},
                                                                 {"spec", "init", "-h"},
                                                                 {"render", "-h"}}));
    const ProgramResult result = run_program(line);
    CAPTURE(line);
    CHECK(result.exit_code == 0);
    CHECK(result.err.empty());
    CHECK(result.out.size() > 5);
    for (const auto& mistake : {std::vector<std::string>{}, {"carv"}, {"carve"}, {"spec"}})
        CHECK(run_program(mistake).exit_code == 1);
}

TEST_CASE("cli: carve writes every format, streams equal files, runs repeat", "[cli][determinism]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    std::filesystem::create_directory(folder / "elsewhere");
    spit(folder / "elsewhere/vase.off", vase_off());
    for (const std::string extension : {"3mf", "stl", "obj", "ply", "off", "amf", "glb"}) {
        CAPTURE(extension);
        // A stream of OBJ goes without the file of its colours.
        const std::vector<std::string> pattern = {
            "--pattern", "cells", "-D", std::string("output.colour=") + (extension == "obj" ? "none" : "exemplar")};
        const auto carve = [&](std::vector<std::string> more, const std::string& input = {}) {
            more.insert(more.end(), pattern.begin(), pattern.end());
            const ProgramResult run = run_program(carve_line(more), input);
            CAPTURE(run.err);
            REQUIRE(run.exit_code == 0);
            return run;
        };
        const std::string target = folder / ("out." + extension);
        CHECK(carve({folder / "vase.off", "-o", target, "--threads", "1"}).out.empty());
        const std::string bytes = slurp(target);
        if (extension != "glb") {
            const MeshReport report =
                report_mesh(read_mesh(std::filesystem::path(target)).mesh, CountSelfIntersections::kYes);
            CHECK(report.self_intersections == 0);
            CHECK(report.closed_manifold());
        }
        // The same bytes through the streams, and from the same file in another folder.
        const ProgramResult stream = carve(
            {"-", "--input-format", "off", "--input-name", "vase.off", "-o", "-", "--export-format", extension, "-q"},
            vase_off());
        CHECK(stream.err.empty());
        CHECK((stream.out == bytes));
        const ProgramResult again =
            carve({folder / "elsewhere/vase.off", "-o", "-", "--export-format", extension, "--threads", "2"});
        CHECK((again.out == bytes));
    }
}

TEST_CASE("cli: convert reads and writes every format, through files and streams alike", "[cli][determinism]") {
    const TemporaryFolder folder;
    TriangleMesh torus = testing::make_torus(20, 6, 12, 8);
    for (Vec3& p : torus.positions_mm) p = p.cast<float>().cast<double>();
    spit(folder / "torus.off", write_mesh({torus, {}, "torus"}, MeshFormat::kOff));
    for (const std::string from : {"3mf", "stl", "obj", "ply", "off", "amf"}) {
        const std::string source = folder / ("torus." + from);
        if (from != "off") REQUIRE(run_program({"convert", folder / "torus.off", source}).exit_code == 0);
        for (const std::string to : {"3mf", "stl", "obj", "ply", "off", "amf", "glb"}) {
            CAPTURE(from, to);
            const std::string target = folder / ("out." + to);
            REQUIRE(run_program({"convert", source, target}).exit_code == 0);
            const ProgramResult stream = run_program(
                {"convert", "-", "-", "--input-format", from, "--input-name", "torus." + from, "--export-format", to},
                slurp(source));
            CHECK(stream.err.empty());
            CHECK((stream.out == slurp(target)));
            if (to == "glb") continue;
            const MeshReport report = report_mesh(read_mesh(std::filesystem::path(target)).mesh);
            CHECK(report.triangles == torus.triangles.size());
            CHECK(report.volume_mm3 == Approx(testing::volume_mm3(torus)).epsilon(1e-5));
        }
    }
    CHECK(run_program({"convert", folder / "torus.off", "-", "--export-format", "stl", "--input-name", "x.off"})
              .exit_code == 1);
    // Without a name it is what messages call it.
    const ProgramResult unnamed = run_program({"convert", "-", "-", "--input-format", "off", "--export-format", "obj"},
                                              slurp(folder / "torus.off"));
    CHECK_THAT(unnamed.out, Catch::Contains("\no standard_input\n"));
}

TEST_CASE("cli: carve writes summary, preview and dependencies", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "my vase.off", vase_off());
    spit(folder / "cells.toml", "[exemplar]\npattern = \"cells\"\n[shell]\nthickness_mm = 4.0\n");
    spit(folder / "sets.json", R"({"parameterSets": {"small": {"synthesis.seed": "5"}}, "fileFormatVersion": "1"})");
    const ProgramResult result = run_program(
        carve_line({folder / "my vase.off", "--pattern", folder / "cells.toml", "-p", folder / "sets.json", "-P",
                    "small", "-D", "shell.thickness_mm=4.5", "-o", folder / "out.stl", "--summary", folder / "out.json",
                    "--preview", folder / "out.png", "-d", folder / "out.d", "--progress", "json"}));
    CAPTURE(result.err);
    REQUIRE(result.exit_code == 0);
    const Json summary = Json::parse(slurp(folder / "out.json"));
    CHECK(summary["settings"]["shell"]["thickness_mm"] == 4.5);  // -D wins over the spec
    CHECK(summary["seed"] == 5);                                 // -P wins over the default
    CHECK(summary["printability"]["one_piece"] == true);
    CHECK(read_image(std::filesystem::path(folder / "out.png")).width == 512);  // of a draft; 1200 else
    const std::string rule = slurp(folder / "out.d");
    CHECK(rule.starts_with((folder / "out.stl") + ":"));
    CHECK(rule.find("my\\ vase.off") != std::string::npos);
    for (const char* name : {"cells.toml", "sets.json"}) CHECK(rule.find(name) != std::string::npos);

    std::istringstream lines(result.err);
    double last = -1.0;
    for (std::string line; std::getline(lines, line);) {
        if (!line.starts_with("{")) continue;
        const Json progress = Json::parse(line);
        CHECK(progress["fraction"].get<double>() >= last);
        CHECK_FALSE(progress["stage"].get<std::string>().empty());
        last = progress["fraction"];
    }
    CHECK(last == 1.0);
}

TEST_CASE("cli: check writes nothing and tells the numbers of the full run", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    const ProgramResult result = run_program(
        {"carve", folder / "vase.off", "--pattern", "cells", "--check", "--summary", "-", "--progress", "json"});
    CHECK(result.exit_code == 0);
    CHECK(Json::parse(result.out)["shell"]["resolution"] == 256);
    CHECK(result.err.find("can be carved") != std::string::npos);
    CHECK(folder.names() == std::vector<std::string>{"vase.off"});
}

TEST_CASE("commands: parts that touch come out as one piece, and warning and summary agree on it", "[cli]") {
    const TemporaryFolder folder;
    const auto carve_with_gap = [&](double gap_mm) {
        write_mesh(std::filesystem::path(folder / "boxes.stl"),
                   {testing::joined(testing::make_box(Vec3(0, 0, 0), Vec3(20, 20, 20)),
                                    testing::make_box(Vec3(20 + gap_mm, 20 + gap_mm, 0), Vec3(40, 40, 20)))});
        const ProgramResult run = run_program({"carve", folder / "boxes.stl", "--pattern", "cells", "--resolution",
                                               "64", "-D", "structure.max_iterations=2", "-o", folder / "out.stl"});
        CHECK(run.exit_code == 0);
        return run.err;
    };
    const std::string touching = carve_with_gap(0.0), apart = carve_with_gap(2.0);
    CHECK_THAT(touching, Catch::Contains("2 parts of the model touch each other and came out as 1") &&
                             Catch::Contains(" 1 piece,"));
    CHECK_THAT(apart, !Catch::Contains("touch each other") && Catch::Contains(" 2 pieces,"));
}

TEST_CASE("commands: a check tells what a run would come to, and what the printer is too small for", "[cli]") {
    const TemporaryFolder folder;
    write_mesh(std::filesystem::path(folder / "vase.off"), {testing::make_vase(60.0)});
    const auto profile = [&](const std::string& bed) {
        spit(folder / "printer.ini", "bed_shape = 0x0," + bed + "x0," + bed +
                                         "x50,0x50\nmax_print_height = 300\n"
                                         "nozzle_diameter = 0.4,0.4\n");
        return folder / "printer.ini";
    };
    const auto check = [&](const std::string& bed, const std::string& size_mm) {
        const ProgramResult run = run_program({"carve", folder / "vase.off", "--pattern", "cells", "--size-mm", size_mm,
                                               "--check", "--slice", profile(bed), "--summary", "-"});
        CAPTURE(run.err);
        REQUIRE(run.exit_code == 0);
        return nlohmann::json::parse(run.out);
    };
    const auto says = [](const nlohmann::json& report, const std::string& what) {
        return std::ranges::any_of(report["warnings"], [&](const nlohmann::json& w) {
            return w.get<std::string>().find(what) != std::string::npos;
        });
    };
    const auto fits = check("50", "60");
    CHECK_FALSE(says(fits, "printer"));
    CHECK(fits["pattern"]["solid_fraction"].get<double>() > 0.2);
    CHECK(fits["pattern"]["solid_fraction"].get<double>() < 0.95);
    CHECK(says(check("20", "60"), "--size-mm"));
    CHECK(says(check("20", "60"), "reaches 20 x 50 x 300 mm"));
}

TEST_CASE("cli: an interrupted run exits with 130 and leaves nothing", "[cli][cancel]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    const int delay_ms = GENERATE(50, 400, 900);
    const int signal = GENERATE(SIGINT, SIGTERM, SIGHUP);
    CAPTURE(delay_ms, signal);
    const ProgramResult result = run_program(
        {"carve", folder / "vase.off", "--pattern", "cells", "-o", folder / "out.3mf"}, {}, [&](int process) {
            std::this_thread::sleep_for(std::chrono::milliseconds(delay_ms));
            ::kill(process, signal);
        });
    // At first it may not be listening yet.
    CHECK((result.exit_code == 130 || (delay_ms == 50 && result.exit_code == 128 + signal)));
    if (delay_ms > 50) CHECK(result.err.find("cancelled") != std::string::npos);
    CHECK(folder.names() == std::vector<std::string>{"vase.off"});
}

TEST_CASE("cli: --strict exits with 4 where the stress stays too high, and the result is there all the same", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    // No bridge makes a thin wall of PLA a hundred times safer than handling asks.
    const auto carve_with = [&](const char* safety_factor, const char* target) {
        return run_program(carve_line({folder / "vase.off", "--pattern", "cells", "-o", folder / target, "--strict",
                                       "-D", std::string("structure.safety_factor=") + safety_factor}));
    };
    const ProgramResult weak = carve_with("100", "weak.off");
    CHECK(weak.exit_code == 4);
    CHECK(weak.err.find("over the allowable stress") != std::string::npos);
    CHECK(std::filesystem::exists(folder / "weak.off"));
    CHECK(carve_with("1", "firm.off").exit_code == 0);
}

TEST_CASE("cli: --verify-and-reinforce judges by the full analysis, and says what it cannot mend", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    const auto carve_with = [&](const std::string& force_n, const std::string& name) {
        return run_program({"carve", folder / "vase.off", "--pattern", "cells", "--resolution", "48", "-D",
                            "structure.max_iterations=1", "-D", "structure.samples=60", "-D",
                            "structure.handling_force_n=" + force_n, "--verify-and-reinforce", "--strict", "-o",
                            folder / (name + ".3mf"), "--summary", folder / (name + ".json")});
    };
    const auto strength_in = [&](const char* name) { return Json::parse(slurp(folder / name))["strength"]; };
    const ProgramResult weak = carve_with("3000", "weak");
    CHECK(weak.exit_code == 4);
    CHECK(weak.err.find("factor of safety") != std::string::npos);
    const Json falls_short = strength_in("weak.json");
    const bool filled = falls_short["stopped_by"] == "nothing to fill" || falls_short["stopped_by"] == "no gain";
    CHECK(weak.err.find(filled ? "a thicker wall is" : "material_budget may help") != std::string::npos);
    CHECK(falls_short["holds"] == false);
    CHECK(falls_short["rounds"].size() > 1);
    CHECK(falls_short["faults"].size() == 1);

    const ProgramResult firm = carve_with("1", "firm");
    CHECK(firm.err.find("allowable") == std::string::npos);
    const Json holds = strength_in("firm.json");
    CHECK(holds["stopped_by"] == "holds");
    // What verify finds in the file is what the run has said.
    const Json verified = Json::parse(run_program({"verify", folder / "firm.3mf", "--json"}).out);
    CHECK(verified["strength"]["factor_of_safety"].get<double>() ==
          Approx(holds["factor_of_safety"].get<double>()).epsilon(1e-3));
}

TEST_CASE("cli: info describes models, pictures and specs", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    spit(folder / "a.toml", "[shell]\nthickness_mm = 4\n[[keep]]\nshape = \"everywhere\"\n");
    const Json mesh = Json::parse(run_program({"info", folder / "vase.off", "--json"}).out);
    CHECK(mesh["mesh"]["closed"] == true);
    CHECK(mesh["mesh"]["components"] == 1);
    CHECK(mesh["size_mm"][2] == Approx(50.0));
    CHECK(run_program({"info", folder / "vase.off"}).out.find("mesh.closed = true\n") != std::string::npos);
    const Json spec = Json::parse(run_program({"info", folder / "a.toml", "--json"}).out);
    CHECK(spec["changed"]["shell"]["thickness_mm"] == 4.0);
    CHECK(spec["keep"] == 1);
    REQUIRE(run_program({"pattern", "show", "cells", "-o", folder / "cells.png"}).exit_code == 0);
    const Json picture = Json::parse(run_program({"info", folder / "cells.png", "--json"}).out);
    CHECK(picture["usable"] == true);
    CHECK(picture["width_px"] >= 128);
    CHECK(run_program({"info", folder / "none.stl"}).exit_code == 2);
}

TEST_CASE("cli: patterns are listed, shown and previewed", "[cli]") {
    const TemporaryFolder folder;
    const ProgramResult list = run_program({"pattern", "list"});
    for (const BuiltinPattern& pattern : builtin_patterns())
        CHECK(list.out.find(std::string(pattern.name) + " ") != std::string::npos);
    CHECK(Json::parse(run_program({"pattern", "list", "--json"}).out).size() == builtin_patterns().size());
    CHECK(Json::parse(run_program({"pattern", "show", "dots", "--json"}).out)["connected"] == false);
    CHECK(run_program({"pattern", "show", "none"}).exit_code == 1);
    const ProgramResult preview = run_program(
        {"pattern", "preview", "hexagons", "-o", folder / "hexagons.png", "--resolution", "40", "--width-mm", "30"});
    CAPTURE(preview.err);
    REQUIRE(preview.exit_code == 0);
    CHECK(read_image(std::filesystem::path(folder / "hexagons.png")).height == 1200);
}

TEST_CASE("cli: specs are started, checked and described", "[cli]") {
    const TemporaryFolder folder;
    REQUIRE(
        run_program({"spec", "init", "--preset", "fine", "--pattern", "waves", "-o", folder / "a.toml"}).exit_code ==
        0);
    CHECK(run_program({"spec", "check", folder / "a.toml"}).exit_code == 0);
    const Json spec = Json::parse(run_program({"info", folder / "a.toml", "--json"}).out);
    CHECK(spec["changed"]["exemplar"]["pattern"] == "waves");
    CHECK(Json::parse(run_program({"spec", "schema"}).out)["type"] == "object");
    spit(folder / "b.toml", "[exemplar]\nimage = \"gone.png\"\n");
    CHECK(run_program({"spec", "check", folder / "b.toml"}).exit_code == 2);
    spit(folder / "c.toml", "[exemplar]\nimagge = \"gone.png\"\n");
    CHECK(run_program({"spec", "check", folder / "c.toml"}).exit_code == 1);
}

TEST_CASE("cli: convert keeps the mesh and scales units", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    REQUIRE(run_program({"convert", folder / "vase.off", folder / "vase.3mf", "--input-unit", "inch"}).exit_code == 0);
    const MeshFile before = read_mesh(std::filesystem::path(folder / "vase.off"));
    const MeshFile after = read_mesh(std::filesystem::path(folder / "vase.3mf"));
    CHECK(after.mesh.triangles.size() == before.mesh.triangles.size());
    CHECK(report_mesh(after.mesh).max_mm[2] == Approx(50.0 * 25.4));
    const ProgramResult stream =
        run_program({"convert", "-", "-", "--input-format", "off", "--export-format", "off"}, vase_off());
    CHECK(stream.out == vase_off());
}

TEST_CASE("cli: an OBJ takes its colours along and make knows of them", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.mtl", "newmtl clay\nKd 0.8 0.4 0.2\n");
    const std::string obj = write_mesh({testing::make_vase(50.0, 32, 16)}, MeshFormat::kObj);
    spit(folder / "vase.obj", "mtllib vase.mtl\nusemtl clay\n" + obj);
    REQUIRE(run_program({"convert", folder / "vase.obj", folder / "copy.obj"}).exit_code == 0);
    const MeshFile copy = read_mesh(std::filesystem::path(folder / "copy.obj"));
    REQUIRE(copy.triangle_colors.size() == copy.mesh.triangles.size());
    CHECK(copy.triangle_colors[0] == Rgb8{204, 102, 51});
    CHECK(folder.names() == std::vector<std::string>{"copy.mtl", "copy.obj", "vase.mtl", "vase.obj"});
    REQUIRE(run_program(carve_line({folder / "vase.obj", "--pattern", "cells", "-o", folder / "out.stl", "-d",
                                    folder / "out.d"}))
                .exit_code == 0);
    CHECK(slurp(folder / "out.d").find("vase.mtl") != std::string::npos);
}

TEST_CASE("cli: a region may name a part of the file", "[cli]") {
    const TemporaryFolder folder;
    const TriangleMesh vase = testing::make_vase(50.0, 32, 16);
    std::string obj = write_mesh({vase}, MeshFormat::kObj);
    std::size_t half = obj.find("\nf ");
    for (std::size_t t = 0; t < vase.triangles.size() / 2; ++t) half = obj.find("\nf ", half + 1);
    obj.insert(obj.find("\nf "), "\no first half");
    obj.insert(obj.find("\nf ", half + 5), "\no second");
    spit(folder / "vase.obj", obj);
    const auto with_region = [&](const std::string& names) {
        spit(folder / "s.toml",
             "[exemplar]\npattern = \"cells\"\n[[keep]]\nshape = \"named\"\nnames = \"" + names + "\"\n");
        return run_program(carve_line({folder / "vase.obj", "--pattern", folder / "s.toml", "-o", folder / "out.stl",
                                       "--summary", folder / "out.json"}));
    };
    const ProgramResult kept = with_region("first half");
    CAPTURE(kept.err);
    REQUIRE(kept.exit_code == 0);
    const Json summary = Json::parse(slurp(folder / "out.json"));
    const double share =
        summary["pattern"]["kept_voxels"].get<double>() / summary["shell"]["surface_voxels"].get<double>();
    CHECK(share > 0.2);
    CHECK(share < 0.8);
    const ProgramResult unknown = with_region("lid");
    CHECK(unknown.exit_code == 1);
    CHECK(unknown.err.find("first half, second") != std::string::npos);
}

TEST_CASE("cli: render draws sheets of views", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    REQUIRE(run_program({"render", folder / "vase.off", "-o", folder / "v.png", "--size", "64x48", "--views", "4"})
                .exit_code == 0);
    const Image sheet = read_image(std::filesystem::path(folder / "v.png"));
    CHECK(sheet.width >= 2 * 64);
    CHECK(sheet.height >= 2 * 48);
    CHECK(run_program({"render", folder / "vase.off", "-o", folder / "v.png", "--size", "big"}).exit_code == 1);
    CHECK(run_program({"render", folder / "vase.off", "-o", folder / "v.png", "--size", "8"}).exit_code == 1);
}

TEST_CASE("cli: carve --strict counts what is against printing", "[cli]") {
    const TemporaryFolder folder;
    write_mesh(std::filesystem::path(folder / "ball.stl"), {testing::make_icosphere(10.0, 4)});
    // The thinner the first layer, the less of a ball stands on the bed.
    const auto with_layers_of = [&](const char* height) {
        return run_program({"carve", folder / "ball.stl", "--pattern", "dots", "-D", "exemplar.invert=true",
                            "--resolution", "40", "-D", std::string("fabrication.layer_height_mm=") + height,
                            "--strict", "-o", folder / "ball.3mf"});
    };
    const ProgramResult thick = with_layers_of("0.4");
    CAPTURE(thick.err);
    CHECK(thick.exit_code == 0);
    const ProgramResult thin = with_layers_of("0.01");
    CAPTURE(thin.err);
    CHECK(thin.exit_code == 4);
    CHECK(thin.err.find("stand on the bed") != std::string::npos);
}

}  // namespace
}  // namespace fretwork
