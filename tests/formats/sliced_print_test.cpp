// What slicers hand back: G-code, and pictures for resin printers.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>

#include "core/base/error.h"
#include "formats/atomic_write.h"
#include "formats/cura_definition.h"
#include "formats/gcode_reader.h"
#include "formats/png_writer.h"
#include "formats/sla_reader.h"
#include "formats/zip_writer.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

namespace fs = std::filesystem;

/// Rectangles from the bed up, one list per layer, as PrusaSlicer writes them.
std::string gcode_of(const std::vector<std::vector<std::pair<Vec2, Vec2>>>& layers, double height,
                     const std::string& type = "External perimeter") {
    std::string text = "; external perimeters extrusion width = 0.45mm\nG90\nM83\n;TYPE:Custom\nG1 X1 Y1 E2\n";
    double z = 0.0;
    for (const auto& rectangles : layers) {
        z += height;
        if (rectangles.empty()) continue;
        text += ";LAYER_CHANGE\n;Z:" + std::to_string(z) + "\n;HEIGHT:" + std::to_string(height) + "\nG1 Z" +
                std::to_string(z) + " F9000\n;TYPE:" + type + "\n";
        for (const auto& [low, high] : rectangles) {
            const auto go = [&](double x, double y, bool push) {
                text += "G1 X" + std::to_string(x) + " Y" + std::to_string(y) + (push ? " E0.5" : "") + "\n";
            };
            go(low[0], low[1], false), go(high[0], low[1], true), go(high[0], high[1], true);
            go(low[0], high[1], true), go(low[0], low[1], true);
        }
    }
    return text +
           "; filament used [mm] = 123.5\n; filament used [cm3] = 0.3\n; filament used [g] = 0.37\n"
           "; estimated printing time (normal mode) = 1h 2m 3s\n; bed_shape = 0x0,50x0,50x40,0x40\n"
           "; max_print_height = 30\n";
}

const std::vector<std::pair<Vec2, Vec2>> kPair = {{Vec2(10, 10), Vec2(14, 14)}, {Vec2(20, 10), Vec2(22, 14)}};

TEST_CASE("gcode: layers, totals and room are read", "[formats][gcode]") {
    const SlicedPrint print = read_gcode(gcode_of({kPair, kPair, kPair}, 0.2), "a.gcode");
    REQUIRE(print.layers.size() == 3);
    CHECK(print.layers[2].top_mm == Approx(0.6));
    CHECK(print.layers[2].height_mm == Approx(0.2));
    CHECK(print.seconds == 3723.0);
    CHECK(print.filament_mm == 123.5);
    CHECK(print.filament_g == 0.37);
    CHECK(print.material_ml == 0.3);
    CHECK(print.line_mm == 0.45);
    CHECK(print.empty_between_mm.empty());
    REQUIRE(print.room_mm);
    CHECK((*print.room_mm)[1] == Vec3(50, 40, 30));
    CHECK(print.max_mm.isApprox(Vec3(22, 14, 0.6)));
    for (const Vec2& p : print.layers[0].points_mm) CHECK(p[0] >= 10.0);
}

TEST_CASE("gcode: lengths of filament may be told from the start", "[formats][gcode]") {
    const SlicedPrint print =
        read_gcode("M82\nG1 Z0.3\nG1 X5 Y5 E1\nG1 X9 Y5 E3\nG92 E0\nG1 X9 Y9 E1\nG1 X5 Y9 E0.5\nG91\nG1 X1 E1\n", "a");
    REQUIRE(print.layers.size() == 1);
    CHECK(print.layers[0].top_mm == 0.3);
    CHECK(print.max_mm[0] == 9.0);
    // It draws back on the way to (5, 9), and prints the last millimetre.
    CHECK(print.layers[0].points_mm.back() == Vec2(6, 9));
    for (const Vec2& p : print.layers[0].points_mm) CHECK_FALSE((p[1] == 9.0 && p[0] > 6.0 && p[0] < 9.0));
    CHECK_THROWS_AS(read_gcode("G1 X5 Y5\n; nothing\n", "empty.gcode"), InvalidInput);
    CHECK_THROWS_WITH(read_gcode("M83\nG1 X5e9 Y5 E1\n", "far.gcode"), Catch::Contains("far.gcode"));
    std::string endless = "M83\n";
    for (int i = 0; i < 4000; ++i) endless += "G1 X9999 E1\nG1 X-9999 E1\n";
    CHECK_THROWS_WITH(read_gcode(endless, "long.gcode"), Catch::Contains("20 km"));
}

TEST_CASE("gcode: CuraEngine's model begins after the nozzle is clean", "[formats][gcode]") {
    const SlicedPrint print = read_gcode(
        "M82\nG1 X1 Y20 Z0.3\nG1 X1 Y200 E15\n;LAYER_COUNT:1\n;LAYER:0\nG0 X9 Y9 Z0.2\n;TYPE:SKIRT\nG1 X30 Y9 E16\n"
        ";TYPE:WALL-OUTER\nG0 X12 Y12\nG1 X14 Y12 E17\n;TYPE:SUPPORT-INTERFACE\nG1 X20 Y30 E18\n",
        "a.gcode");
    REQUIRE(print.layers.size() == 1);
    CHECK(print.layers[0].top_mm == 0.2);
    for (const Vec2& p : print.layers[0].points_mm) CHECK((p[0] >= 12.0 && p[0] <= 14.0 && p[1] == 12.0));
    CHECK(print.max_mm.isApprox(Vec3(30, 30, 0.2)));
}

TEST_CASE("gcode: a height without a line is told", "[formats][gcode]") {
    const SlicedPrint print = read_gcode(gcode_of({kPair, kPair, {}, {}, kPair, kPair, {}, kPair}, 0.2), "a.gcode");
    REQUIRE(print.empty_between_mm.size() == 2);
    CHECK(print.empty_between_mm[0].isApprox(Vec2(0.4, 0.8)));
    CHECK(print.empty_between_mm[1].isApprox(Vec2(1.2, 1.4)));
    // Support stands in for nothing of the object.
    CHECK_THROWS_AS(read_gcode(gcode_of({kPair}, 0.2, "Support material"), "a.gcode"), InvalidInput);
}

TEST_CASE("lost parts: what no line runs through is found, wherever the slicer put the model", "[printability]") {
    // Two blocks; in layers 5 and 6 the second is not printed.
    TriangleMesh mesh = testing::make_box(Vec3(-1, 3, 7), Vec3(3, 7, 9));
    const TriangleMesh second = testing::make_box(Vec3(9, 3, 7), Vec3(11, 7, 9));
    for (const Triangle& t : second.triangles) mesh.triangles.push_back({t[0] + 8, t[1] + 8, t[2] + 8});
    mesh.positions_mm.insert(mesh.positions_mm.end(), second.positions_mm.begin(), second.positions_mm.end());
    REQUIRE(mesh.positions_mm.size() == 16);
    std::vector<std::vector<std::pair<Vec2, Vec2>>> layers(10, kPair);
    const LostParts all = find_lost_parts(mesh, read_gcode(gcode_of(layers, 0.2), "a").layers, 0.45);
    CHECK(all.compared);
    CHECK(all.places.empty());
    layers[5].pop_back();
    layers[6].pop_back();
    const LostParts lost = find_lost_parts(mesh, read_gcode(gcode_of(layers, 0.2), "a").layers, 0.45);
    CHECK(lost.compared);
    REQUIRE(lost.places.size() == 2);
    CHECK(lost.places[0].at_mm.isApprox(Vec3(10, 5, 8.1)));
    // Arranged anew, it cannot be told.
    for (auto& rectangles : layers) rectangles = {{Vec2(10, 10), Vec2(40, 14)}};
    CHECK_FALSE(find_lost_parts(mesh, read_gcode(gcode_of(layers, 0.2), "a").layers, 0.45).compared);
}

std::string archive_of(const std::vector<bool>& lit) {
    ZipWriter zip;
    zip.add("config.ini", "layerHeight = 0.05\nprintTime = 90.5\nusedMaterial = 1.25\n");
    for (std::size_t i = 0; i < lit.size(); ++i) {
        Image picture{4, 3, std::vector<Rgba8>(12, Rgba8{0, 0, 0, 255}), false};
        if (lit[i]) picture.pixels[5] = {255, 255, 255, 255};
        zip.add("print0000" + std::to_string(i) + ".png", write_png(picture));
    }
    return zip.finish();
}

TEST_CASE("resin: dark pictures between others are gaps", "[formats]") {
    const SlicedPrint print = read_sla_archive(archive_of({true, false, false, true, true, false}), "a.sl1");
    CHECK(print.layers.size() == 3);
    CHECK(print.layers.back().top_mm == Approx(0.25));
    REQUIRE(print.empty_between_mm.size() == 1);
    CHECK(print.empty_between_mm[0].isApprox(Vec2(0.05, 0.15)));
    CHECK(print.seconds == 90.5);
    CHECK(print.material_ml == 1.25);
    CHECK_THROWS_AS(read_sla_archive(archive_of({}), "a.sl1"), InvalidInput);
    CHECK_THROWS_AS(read_sla_archive("no archive", "a.sl1"), InvalidInput);
}

TEST_CASE("cura definition: the printer's room and nozzle, of itself and what it builds on", "[formats][cura]") {
    const fs::path folder = fs::temp_directory_path() / ("fretwork_cura_" + std::to_string(::getpid()));
    fs::create_directory(folder);
    const auto definition = [&](const std::string& name, const std::string& text) {
        atomic_write(folder / (name + ".def.json"), text);
        return folder / (name + ".def.json");
    };
    definition("base", R"({"settings": {"m": {"children": {"machine_width": {"default_value": 100, "value": "7"},
        "machine_depth": {"default_value": 90, "children": {"machine_height": {"default_value": 80}}}}}}})");
    const fs::path child =
        definition("child", R"({"inherits": "base", "overrides": {"machine_width": {"default_value": 120.5},
        "machine_center_is_zero": {"default_value": true}, "machine_nozzle_size": {"default_value": 0.6}}})");
    const CuraPrinter printer = read_cura_definition(child);
    REQUIRE(printer.room_mm);
    CHECK((*printer.room_mm)[0].isApprox(Vec3(-60.25, -45, 0)));
    CHECK((*printer.room_mm)[1].isApprox(Vec3(60.25, 45, 80)));
    CHECK(printer.nozzle_mm == 0.6);
    CHECK(printer.files == std::vector<fs::path>{child, folder / "base.def.json"});

    // What is not beside it the engine may find elsewhere; a name does not lead out of the folder.
    for (const char* parent : {"fdmprinter", "../base", "..", ""}) {
        CAPTURE(parent);
        const CuraPrinter alone = read_cura_definition(definition(
            "alone",
            std::string(R"({"inherits": ")") + parent + R"(", "settings": {"machine_width": {"default_value": -5}}})"));
        CHECK(alone.files.size() == (std::string(parent) == "../base" ? 2 : 1));
        CHECK_FALSE(alone.room_mm);  // no printer is -5 mm wide
    }
    const fs::path endless = definition("endless", R"({"inherits": "endless"})");
    CHECK_THROWS_WITH(read_cura_definition(endless), Catch::Contains("over 16 definitions"));
    CHECK_THROWS_WITH(read_cura_definition(definition("cut", "{\"a\": ")), Catch::Contains("cut.def.json: byte "));
    CHECK_THROWS_WITH(read_cura_definition(definition("list", "[1]")), Catch::Contains("found array"));
    CHECK_THROWS_WITH(read_cura_definition(definition("deep", std::string(70, '[') + std::string(70, ']'))),
                      Catch::Contains("64 deep"));
    CHECK_THROWS_AS(read_cura_definition(folder / "none.def.json"), FileError);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace fretwork
