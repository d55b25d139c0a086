// DESIGN section 10: each kind of bad input has its exit code, one line on stderr, and leaves nothing behind.
#include <array>
#include <catch2/catch.hpp>

#include "cli/run_program.h"
#include "core/mesh/mesh_report.h"
#include "formats/mesh_file.h"
#include "formats/png_writer.h"
#include "support/coded_pictures.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"
#include "support/make_pictures.h"

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
    std::string name;
    std::string bytes;
    std::string expected = {};  ///< in the message, besides the name of the file
};

std::string model_3mf(const std::string& resources, const std::string& build = "<item objectid=\"1\"/>") {
    return testing::make_package(testing::make_model(resources, build));
}

/// An object of one triangle, one number of which is spoilt.
std::string one_triangle(const std::string& x, const std::string& index) {
    return model_3mf("<object id=\"1\"><mesh><vertices>\n<vertex x=\"" + x +
                     "\" y=\"0\" z=\"0\"/>\n<vertex x=\"1\" y=\"0\" z=\"0\"/>\n<vertex x=\"0\" y=\"1\" z=\"0\"/>"
                     "</vertices><triangles>\n<triangle v1=\"0\" v2=\"1\" v3=\"" +
                     index + "\"/></triangles></mesh></object>");
}

std::vector<BadModel> bad_models() {
    const std::string off = vase_off();
    const std::string vertices =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string ply = vertices + "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::string amf = "<amf unit=\"millimeter\"><object id=\"1\"><mesh><vertices>";
    const auto amf_vertex = [](const std::string& x) {
        return "<vertex><coordinates><x>" + x + "</x><y>1</y><z>2</z></coordinates></vertex>\n";
    };
    const auto amf_end = [](const std::string& index) {
        return "</vertices><volume><triangle><v1>0</v1><v2>1</v2><v3>" + index +
               "</v3></triangle></volume></mesh></object></amf>";
    };
    const auto facet = [](const std::string& z) {
        return "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 9 0 0\nvertex 0 9 " + z +
               "\nendloop\nendfacet\nendsolid s\n";
    };
    return {
        // Empty and truncated.
        {"empty.stl", "", "byte 0"},
        {"empty.obj", ""},
        {"empty.ply", ""},
        {"empty.off", ""},
        {"empty.3mf", ""},
        {"empty.amf", ""},
        {"cut.off", off.substr(0, off.size() / 2), "line "},
        {"cut.stl", facet("0").substr(0, 60), "line "},
        {"cut.ply", ply + "0 0 0\n1 0 0\n", "end of the file"},
        {"cut.amf", amf + amf_vertex("0"), "line "},
        {"cut.3mf", one_triangle("0", "2").substr(0, 300), "archive"},
        // Another type than the name says.
        {"text.obj", "hello world\n", "no triangle"},
        {"text.off", "hello world\n", "hello"},
        {"text.ply", "hello world\n", "hello"},
        {"text.stl", "hello world\n"},
        {"text.amf", "hello world\n"},
        {"text.3mf", "plain text", "ZIP"},
        {"zip.3mf", "PK\003\004 nothing", "ZIP"},
        {"web.amf", "<html><body/></html>", "html"},
        // Numbers that are none, not finite or too large.
        {"nan.off", "OFF\n3 1 0\n0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "line 3"},
        {"nan.stl", facet("nan"), "line 6"},
        {"inf.obj", "v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n", "line 2"},
        {"nan.ply", ply + "0 0 nan\n1 0 0\n0 1 0\n3 0 1 2\n", "line 10"},
        {"nan.amf", amf + amf_vertex("nan") + amf_vertex("1") + amf_vertex("2") + amf_end("2"), "line 1"},
        {"nan.3mf", one_triangle("nan", "2"), "line 5: found x \"nan\""},
        {"large.3mf", one_triangle("1e38", "2"), "line 5: found x \"1e38\""},
        // Indices past the end, below zero, or that wrap round.
        {"range.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n", "line 6"},
        {"range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n", "line 4"},
        {"range.ply", ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 13"},
        {"range.amf", amf + amf_vertex("0") + amf_vertex("1") + amf_vertex("2") + amf_end("3"), "line "},
        {"range.3mf", one_triangle("0", "3"), "vertex index 3"},
        {"below.3mf", one_triangle("0", "-1"), "\"-1\""},
        {"wrapped.3mf", one_triangle("0", "4294967298"), "\"4294967298\""},
        // No area.
        {"flat.off", "OFF\n3 1 0\n0 0 0\n10 0 0\n20 0 0\n3 0 1 2\n", "area"},
        {"point.stl", std::string(facet("0")).replace(facet("0").find("9 0 0"), 5, "0 0 0"), "area"},
    };
}

void check_refused(const TemporaryFolder& folder, const BadModel& model) {
    CAPTURE(model.name);
    spit(folder / model.name, model.bytes);
    const ProgramResult result =
        run_program({"carve", folder / model.name, "--pattern", "cells", "-o", folder / "out.3mf"});
    CHECK(result.exit_code == 2);
    check_one_line(result);
    CHECK_THAT(result.err, Catch::Contains(model.name));
    CHECK_THAT(result.err, Catch::Contains(model.expected));
    CHECK(folder.names() == std::vector<std::string>{model.name});
    std::filesystem::remove(folder / model.name);
}

TEST_CASE("bad input: models that cannot be read exit with 2 and name file and place", "[cli]") {
    const TemporaryFolder folder;
    for (const BadModel& model : bad_models()) check_refused(folder, model);
    const ProgramResult missing =
        run_program({"carve", folder / "no.stl", "--pattern", "cells", "-o", folder / "out.stl"});
    CHECK(missing.exit_code == 2);
    check_one_line(missing);
}

/// What a package can be made to do; `threemf_reader_test` has more of them, with their time and memory.
TEST_CASE("bad input: hostile packages exit with 2 and name what they tried", "[cli]") {
    const std::string tetrahedron = testing::make_tetrahedron(1);
    const auto named = [&](const std::string& name) {
        const std::string stand_in(name.size(), 'Q');
        return testing::patched(
            testing::make_package(testing::make_model(tetrahedron, "<item objectid=\"1\"/>"), {{stand_in, "x"}}),
            stand_in, name);
    };
    std::string deep = tetrahedron, doubling = tetrahedron;
    for (int id = 2; id <= 40; ++id) {
        const std::string below = "<component objectid=\"" + std::to_string(id - 1) + "\"/>";
        const std::string object = "<object id=\"" + std::to_string(id) + "\"><components>" + below;
        deep += object + "</components></object>";
        if (id <= 30) doubling += object + below + "</components></object>";
    }
    std::string many_items;
    for (int i = 0; i < 20000; ++i)
        many_items += "<item objectid=\"1\" partnumber=\"" + std::to_string(i * 7919) + "\"/>";
    const std::string space = "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"";
    const TemporaryFolder folder;
    for (const BadModel& model : std::vector<BadModel>{
             {"bomb.3mf", testing::make_zip_bomb(200), "ratio"},
             {"entities.3mf",
              testing::make_package("<!DOCTYPE m [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;\">]><model " + space +
                                    "><metadata>&b;</metadata></model>"),
              "document type"},
             {"outside.3mf", testing::make_package("<!DOCTYPE m SYSTEM \"file:///etc/passwd\"><model " + space + "/>"),
              "document type"},
             {"parent.3mf", named("../../../tmp/evil"), "leaves its folder"},
             {"absolute.3mf", named("/tmp/evil"), "absolute"},
             {"backslash.3mf", named("..\\evil"), "backslash"},
             {"twice.3mf", named("3D/3DMODEL.model"), "second entry"},
             {"cycle.3mf", model_3mf("<object id=\"1\"><components><component objectid=\"1\"/></components></object>"),
              "within itself"},
             {"deep.3mf", model_3mf(deep, "<item objectid=\"40\"/>"), "32 levels"},
             {"doubling.3mf", model_3mf(doubling, "<item objectid=\"30\"/>"), "placed meshes"},
             {"items.3mf", model_3mf(tetrahedron, many_items), "placed meshes"},
             {"unknown.3mf",
              testing::make_package(testing::make_model(tetrahedron, "<item objectid=\"1\"/>",
                                                        "requiredextensions=\"z\" xmlns:z=\"urn:z\"")),
              "urn:z"},
         })
        check_refused(folder, model);
}

TEST_CASE("bad input: exemplars that cannot be used exit with 2 and say why", "[cli]") {
    const auto plain = [](int width, int height, int value) {
        return write_png(testing::make_picture(width, height, [&](int, int) { return testing::grey(value); }));
    };
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    for (const auto& [name, bytes, reason] : std::vector<std::array<std::string, 3>>{
             {"not.png", "not a picture", "PNG"},
             {"cut.png", std::string("\x89PNG\r\n\x1a\n", 8), "byte 8"},
             {"empty.png", "", "empty"},
             {"moving.gif", "GIF89a...", "GIF"},
             {"white.png", plain(40, 40, 255), "exemplar"},
             {"black.png", plain(40, 40, 0), "exemplar"},
             {"dot.png", plain(1, 1, 0), "1 x 1"},
         }) {
        CAPTURE(name);
        spit(folder / name, bytes);
        const ProgramResult result =
            run_program({"carve", folder / "vase.off", "--exemplar", folder / name, "-o", folder / "out.stl"});
        CHECK(result.exit_code == 2);
        check_one_line(result);
        CHECK_THAT(result.err, Catch::Contains(name) && Catch::Contains(reason));
        CHECK_FALSE(std::filesystem::exists(folder / "out.stl"));
    }
    const ProgramResult missing =
        run_program({"carve", folder / "vase.off", "--exemplar", folder / "missing.png", "-o", folder / "out.stl"});
    CHECK(missing.exit_code == 2);
    CHECK_THAT(missing.err, Catch::Contains("missing.png"));
    const ProgramResult mask = run_program({"carve", folder / "vase.off", "--exemplar", folder / "white.png", "--mask",
                                            folder / "dot.png", "-o", folder / "out.stl"});
    CHECK(mask.exit_code == 2);
    check_one_line(mask);
}

TEST_CASE("bad input: exemplars of every odd kind work", "[cli]") {
    // Stripes of eight pixels, in different words.
    const auto striped = [](int x) { return x / 8 % 2 == 0; };
    std::vector<std::uint16_t> deep;
    std::vector<std::uint8_t> inks;
    for (int y = 0; y < 32; ++y)
        for (int x = 0; x < 64; ++x) {
            deep.push_back(striped(x) ? 60000 : 300);
            for (int ink = 0; ink < 4; ++ink) inks.push_back(striped(x) ? 250 : 5);
        }
    const auto picture = [&](int width, int height) {
        return write_png(
            testing::make_picture(width, height, [&](int x, int) { return testing::grey(striped(x) ? 255 : 0); }));
    };
    const TemporaryFolder folder;
    spit(folder / "vase.off", vase_off());
    spit(folder / "mask.png", picture(24, 9));
    for (const auto& [name, bytes] : std::vector<std::pair<std::string, std::string>>{
             {"deep.png", testing::make_png(64, 32, {16, 0}, deep)},
             {"alpha.png", write_png(testing::make_picture(
                               64, 32, [&](int x, int) { return testing::grey(0, striped(x) ? 255 : 0); }, true))},
             {"inks.jpg", testing::make_jpeg(64, 32, testing::JpegKind::kCmykAdobe, inks)},
             {"wide.png", picture(9000, 200)},
             {"small.png", picture(16, 16)},
         }) {
        CAPTURE(name);
        spit(folder / name, bytes);
        for (const bool with_mask : {false, true}) {
            std::vector<std::string> arguments = {"carve",   folder / "vase.off", "--exemplar", folder / name,
                                                  "--check", "--width-mm",        "20"};
            if (with_mask) arguments = joined(arguments, {"--mask", folder / "mask.png"});
            const ProgramResult result = run_program(arguments);
            CAPTURE(with_mask, result.err);
            CHECK(result.exit_code == 0);
        }
    }
}

/// A model with faults that leave its surface meaningful, and the words that count them.
struct MessyModel {
    std::string name;
    TriangleMesh mesh;
    std::string warning;
    std::vector<std::string> arguments = {};
};

TEST_CASE("bad input: messy models are carved, with a warning that counts, into valid meshes", "[cli]") {
    const TriangleMesh sphere = testing::make_icosphere(20.0, 3);
    const TriangleMesh box = testing::make_box(Vec3(0, 0, 0), Vec3(30, 30, 30));
    // Of 1280 triangles every seventh is turned, the first with them.
    const std::vector<MessyModel> models = {
        {"open", testing::make_open_bowl(20.0, 16, 48), "48 border edges", {"-D", "shell.side=\"centred\""}},
        {"flipped", testing::with_flipped(sphere, 7), "183 triangles were turned"},
        {"duplicated", testing::with_duplicates(sphere, 9), "9 duplicate triangles"},
        {"degenerate", testing::with_degenerates(sphere, 6), "6 triangles without area"},
        {"inverted", testing::inverted(sphere), "1 piece was inside out"},
        {"touching", testing::joined(box, testing::translated(box, Vec3(30, 30, 0))),
         "1 edge with more than two triangles"},
        {"crossing", testing::joined(box, testing::translated(box, Vec3(15, 10, 20))), "intersects itself in 12 pairs"},
    };
    const TemporaryFolder folder;
    for (const MessyModel& model : models) {
        CAPTURE(model.name);
        write_mesh(std::filesystem::path(folder / "in.off"), {model.mesh});
        const ProgramResult result =
            run_program(joined({"carve", folder / "in.off", "--pattern", "cells", "--resolution", "40", "--width-mm",
                                "30", "-o", folder / "out.stl"},
                               model.arguments));
        CAPTURE(result.err);
        CHECK(result.exit_code == 0);
        CHECK_THAT(result.err, Catch::Contains("warning") && Catch::Contains(model.warning));
        if (result.exit_code != 0) continue;
        const MeshReport report =
            report_mesh(read_mesh(std::filesystem::path(folder / "out.stl")).mesh, CountSelfIntersections::kYes);
        CHECK(report.closed_manifold());
        CHECK(report.self_intersections == 0);
        CHECK(report.volume_mm3 > 0.0);
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
