// DESIGN section 10: each kind of bad input has its exit code, one line on stderr, and leaves nothing behind.
#include <catch2/catch.hpp>

#include "cli/run_program.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::ProgramResult;
using testing::run_program;
using testing::slurp;
using testing::spit;
using testing::TemporaryFolder;

std::string vase_off() {
    const TriangleMesh vase = testing::make_vase(50.0, 32, 16);
    return write_mesh({vase}, MeshFormat::kOff);
}

std::vector<std::string> joined(std::vector<std::string> head, const std::vector<std::string>& tail) {
    head.insert(head.end(), tail.begin(), tail.end());
    return head;
}

void check_one_line(const ProgramResult& result) {
    CAPTURE(result.err);
    CHECK(result.err.starts_with("fretwork: error: "));
    CHECK(std::count(result.err.begin(), result.err.end(), '\n') == 1);
    CHECK(result.out.empty());
}

struct BadModel {
    const char* name;
    std::string bytes;
    const char* expected;
};

TEST_CASE("bad input: models that cannot be read exit with 2 and name file and place", "[cli]") {
    const std::string good = vase_off();
    const std::vector<BadModel> models = {
        {"empty.stl", "", "empty.stl"},
        {"truncated.off", good.substr(0, good.size() / 2), "truncated.off"},
        {"notamesh.obj", "hello world\n", "notamesh.obj"},
        {"nan.off", "OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "nan.off"},
        {"range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "range.off"},
        {"flat.off", "OFF\n3 1 0\n0 0 0\n10 0 0\n20 0 0\n3 0 1 2\n", "flat.off"},
        {"zip.3mf", "PK\003\004 nothing", "zip.3mf"},
        {"other.3mf", "plain text", "other.3mf"},
    };
    const TemporaryFolder folder;
    for (const BadModel& model : models) {
        CAPTURE(model.name);
        spit(folder / model.name, model.bytes);
        const ProgramResult result =
            run_program({"carve", folder / model.name, "--pattern", "cells", "-o", folder / "out.stl"});
        CHECK(result.exit_code == 2);
        check_one_line(result);
        CHECK(result.err.find(model.expected) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(folder / "out.stl"));
    }
    const ProgramResult missing =
        run_program({"carve", folder / "no.stl", "--pattern", "cells", "-o", folder / "out.stl"});
    CHECK(missing.exit_code == 2);
    check_one_line(missing);
}

TEST_CASE("bad input: exemplars that cannot be used exit with 2 and say why", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    spit(folder / "not.png", "not a picture");
    spit(folder / "cut.png", std::string("\x89PNG\r\n\x1a\n", 8));
    for (const char* name : {"not.png", "cut.png", "missing.png"}) {
        CAPTURE(name);
        const ProgramResult result =
            run_program({"carve", folder / "vase.off", "--exemplar", folder / name, "-o", folder / "out.stl"});
        CHECK(result.exit_code == 2);
        check_one_line(result);
        CHECK(result.err.find(name) != std::string::npos);
    }
}

struct Refusal {
    std::vector<std::string> arguments;
    int exit_code;
    const char* expected;
};

TEST_CASE("bad input: settings and usage", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    spit(folder / "unknown.toml", "[shell]\nthicknes_mm = 2\n");
    spit(folder / "broken.toml", "[shell\n");
    spit(folder / "range.toml", "[shell]\n\nresolution = 3\n");
    spit(folder / "sets.json", R"({"parameterSets": {"dense": {"shell.thickness_mm": "2"}, "odd": {"wall": "2"}},
                                   "fileFormatVersion": "1"})");
    const std::string sets = folder / "sets.json";
    const std::vector<Refusal> refusals = {
        {{"--pattern", "no_such"}, 1, "cells"},
        {{}, 1, "--pattern"},
        {{"--pattern", folder / "unknown.toml"}, 1, "shell.thickness_mm"},
        {{"--pattern", folder / "broken.toml"}, 1, "broken.toml"},
        {{"--pattern", folder / "range.toml"}, 1, "line 3"},
        {{"--pattern", folder / "missing.toml"}, 2, "missing.toml"},
        {{"--pattern", "cells", "-D", "shell.thicknes_mm=2"}, 1, "shell.thickness_mm"},
        {{"--pattern", "cells", "-D", "shell.resolution=ten"}, 1, "shell.resolution"},
        {{"--pattern", "cells", "--set", "nonsense"}, 1, "key=value"},
        {{"--pattern", "cells", "--preset", "turbo"}, 1, "draft"},
        {{"--pattern", "cells", "-p", sets, "-P", "dens"}, 1, "dense"},
        {{"--pattern", "cells", "-p", sets, "-P", "odd"}, 1, "wall"},
        {{"--pattern", "cells", "-P", "dense"}, 1, "-p FILE"},
        {{"--pattern", "cells", "-p", folder / "no.json", "-P", "dense"}, 2, "no.json"},
        {{"--pattern", "cells", "--max-memory", "lots"}, 1, "4G"},
        {{"--pattern", "cells", "--progress", "loud"}, 1, "json"},
        {{"--pattern", "cells", "--no-such-flag"}, 1, "--no-such-flag"},
        {{"--pattern", "cells", "--exemplar", "x.png"}, 1, "exclude"},
        {{"--pattern", "cells", "--mask", "x.png"}, 3, "own mask"},
        {{"--pattern", "cells", "-D", "shell.thickness_mm=0.1"}, 3, "shell.resolution = "},
        {{"--pattern", "cells", "-D", "exemplar.width_mm=400"}, 3, "50 mm"},
        {{"--pattern", "cells", "-D", "fabrication.min_hole_mm=0.2"}, 3, "fabrication.nozzle_mm = 0.4"},
        {{"--pattern", "cells", "--size-mm", "90", "-D", "input.scale=2"}, 3, "input.size_mm"},
        {{"--pattern", "cells", "-D", "input.scale=0.01"}, 3, "--size-mm"},
        {{"--pattern", "cells", "--max-memory", "10M"}, 3, "--max-memory"},
    };
    for (const Refusal& refusal : refusals) {
        const ProgramResult result =
            run_program(joined({"carve", folder / "vase.off", "-o", folder / "out.stl"}, refusal.arguments));
        CAPTURE(refusal.arguments, result.err);
        CHECK(result.exit_code == refusal.exit_code);
        check_one_line(result);
        CHECK(result.err.find(refusal.expected) != std::string::npos);
        CHECK_FALSE(std::filesystem::exists(folder / "out.stl"));
    }
}

TEST_CASE("bad input: outputs that cannot be written leave the target as it was", "[cli]") {
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    const auto carve_to = [&](const std::string& target) {
        return run_program(
            {"carve", folder / "vase.off", "--pattern", "cells", "-o", target, "--export-format", "off"});
    };
    SECTION("no such folder") {
        CHECK(carve_to(folder / "no/out.off").exit_code == 2);
    }
    SECTION("a folder") {
        std::filesystem::create_directory(folder / "out.off");
        CHECK(carve_to(folder / "out.off").exit_code == 2);
        CHECK(std::filesystem::is_directory(folder / "out.off"));
    }
    SECTION("the input") {
        CHECK(carve_to(folder / "vase.off").exit_code == 2);
        CHECK(slurp(folder / "vase.off") == vase_off());
    }
    SECTION("the input by another name") {
        std::filesystem::create_symlink(folder / "vase.off", folder / "link.off");
        CHECK(carve_to(folder / "link.off").exit_code == 2);
        CHECK(slurp(folder / "vase.off") == vase_off());
    }
    SECTION("unknown format") {
        CHECK(run_program({"carve", folder / "vase.off", "--pattern", "cells", "-o", folder / "out.xyz"}).exit_code ==
              1);
    }
    SECTION("a full disk") {
        const ProgramResult result =
            run_program({"convert", folder / "vase.off", "/dev/full", "--export-format", "off"});
        CHECK(result.exit_code == 2);
        CHECK(result.err.find("No space left") != std::string::npos);
        CHECK(std::filesystem::is_character_file("/dev/full"));
    }
    for (const std::string& name : folder.names()) CHECK(name.find(".out") == std::string::npos);
}

}  // namespace
}  // namespace fretwork
