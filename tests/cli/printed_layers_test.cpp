// What `verify` measures on a carved model, against the layers that slic3r draws and the lines that PrusaSlicer prints.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <sstream>

#include "cli/run_program.h"
#include "core/printability/polygons.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"

namespace fretwork::testing {
namespace {

constexpr double kLayerMm = 0.3;
const std::string kBunny = "/usr/share/PrusaSlicer/shapes/bunny.stl";

/// Runs a slicer, or says that it is not there.
bool slicer_ran(const std::string& program, const std::string& arguments) {
    if (std::system(("command -v " + program + " > /dev/null 2>&1").c_str()) != 0) {
        WARN(program << " is not installed: skipped");
        return false;
    }
    REQUIRE(std::system(("timeout 110 " + program + " " + arguments + " > /dev/null 2>&1").c_str()) == 0);
    return true;
}

/// Simple bodies whose layers anybody can tell, and carved ones.
std::string model_in(const TemporaryFolder& folder, const std::string& name) {
    const std::string path = folder / (name + ".stl"), carved = folder / "carved.stl";
    const auto carve = [&](const TriangleMesh& mesh, const char* pattern) {
        write_mesh(std::filesystem::path(path), {mesh});
        const ProgramResult run =
            run_program({"carve", path, "--pattern", pattern, "--size-mm", "40", "--resolution", "64", "-o", carved});
        CAPTURE(run.err);
        REQUIRE(run.exit_code == 0);
        return carved;
    };
    if (name == "vase") return carve(make_vase(30.0), "waves");
    if (name == "bunny") return carve(read_mesh(std::filesystem::path(kBunny)).mesh, "cells");
    TriangleMesh mesh = make_box(Vec3(0, 0, 0), Vec3(20, 10, 6));
    if (name == "bracket") mesh = make_bracket();
    if (name == "islet") mesh = joined(mesh, make_box(Vec3(22, 0, 3), Vec3(25, 4, 6)));
    write_mesh(std::filesystem::path(path), {mesh});
    return path;
}

nlohmann::json measured(const std::string& model) {
    const ProgramResult run = run_program({"verify", model, "--layer-height", "0.3", "--json"});
    CAPTURE(run.err);
    REQUIRE(run.exit_code == 0);
    return nlohmann::json::parse(run.out)["printability"];
}

/// Of one layer as slic3r draws it; contours run counter-clockwise and holes clockwise.
Polygons drawn_polygons(const std::string& group) {
    Polygons all;
    for (std::size_t at = group.find("points=\""); at != group.npos; at = group.find("points=\"", at + 1)) {
        const std::size_t begin = at + 8;
        std::istringstream points(group.substr(begin, group.find('"', begin) - begin));
        Polygon& polygon = all.emplace_back();
        char comma = 0;
        for (double x = 0, y = 0; points >> x >> comma >> y;) polygon.push_back(point_of(Vec2(x, y)));
    }
    return all;
}

std::vector<Polygons> drawn_layers(const std::string& svg) {
    std::vector<Polygons> layers;
    for (std::size_t at = svg.find("<g "); at != svg.npos;) {
        const std::size_t next = svg.find("<g ", at + 1);
        layers.push_back(drawn_polygons(svg.substr(at, next - at)));
        at = next;
    }
    return layers;
}

std::size_t islands_of(const Polygons& layer, const Polygons& below) {
    constexpr double kLeastMm2 = 0.01;
    return static_cast<std::size_t>(std::ranges::count_if(parts_of(layer), [&](const Part& part) {
        return part.area_mm2() > kLeastMm2 && intersection(part.borders, below).empty();
    }));
}

/// Islands of each layer as `verify` lists them.
std::vector<std::size_t> told_islands(const nlohmann::json& print) {
    std::vector<std::size_t> islands(print["layers"].get<std::size_t>(), 0);
    for (const auto& layer : print["island_layers"])
        islands.at(layer["layer"].get<std::size_t>()) = layer["islands"].get<std::size_t>();
    return islands;
}

TEST_CASE("printed layers: islands, overhang and what stands on the bed are those of slic3r's layers",
          "[cli][programs]") {
    const auto* const name = GENERATE("box", "islet", "bracket", "vase", "bunny");
    CAPTURE(name);
    if (std::string(name) == "bunny" && !std::filesystem::exists(kBunny)) return;
    const TemporaryFolder folder;
    const std::string model = model_in(folder, name), drawing = folder / "layers.svg";
    if (!slicer_ran("slic3r", "--export-svg --layer-height 0.3 --first-layer-height 0.3 -o " + drawing + " " + model))
        return;
    const std::vector<Polygons> layers = drawn_layers(slurp(drawing));
    const nlohmann::json print = measured(model);
    const std::vector<std::size_t> told = told_islands(print);
    // slic3r may draw one more, of what rounding leaves at the top.
    REQUIRE(layers.size() >= told.size());
    REQUIRE(layers.size() <= told.size() + 1);

    std::size_t islands = 0, different = 0;
    double overhang = 0.0, volume = 0.0;
    for (std::size_t i = 0; i < told.size(); ++i) {
        volume += kLayerMm * fretwork::area_mm2(layers[i]);
        if (i == 0) continue;
        const std::size_t drawn = islands_of(layers[i], layers[i - 1]);
        // slic3r leaves out points that stray by less than 0.0125 mm: what just touches may no longer.
        CHECK(std::max(drawn, told[i]) - std::min(drawn, told[i]) <= 1);
        different += drawn == told[i] ? 0 : 1;
        islands += drawn;
        overhang += fretwork::area_mm2(difference(layers[i], offset(layers[i - 1], kLayerMm)));
    }
    CAPTURE(islands, told);
    CHECK(different <= 2 + islands / 10);
    if (std::string(name) == "bunny") CHECK(islands > 10);
    if (std::string(name) == "islet") {
        CHECK(told[10] == 1);  // which begins at 3 mm
        CHECK(std::accumulate(told.begin(), told.end(), std::size_t{0}) == 1);
        CHECK(islands == 1);
    }
    CHECK(print["overhang_area_mm2"].get<double>() == Approx(overhang).epsilon(0.02).margin(0.05));
    CHECK(print["first_layer_contact_mm2"].get<double>() ==
          Approx(fretwork::area_mm2(layers[0])).epsilon(0.01).margin(0.05));
    CHECK(print["material_mm3"].get<double>() == Approx(volume).epsilon(0.01));
    if (std::string(name) == "box") CHECK(print["first_layer_contact_mm2"].get<double>() == Approx(200.0));
}

struct PrintedArea {
    double mm2 = 0.0;      ///< what the lines of a layer fill
    bool hanging = false;  ///< any of them printed over air, as the slicer sees it
};

/// By layers, from the plastic that goes into the lines; strings and retractions print nothing.
std::vector<PrintedArea> printed_areas(const std::string& code) {
    constexpr double kFilamentMm = 1.75;
    const double filament_mm2 = kFilamentMm * kFilamentMm * std::numbers::pi / 4.0;
    std::vector<PrintedArea> layers;
    double extruded = 0.0;
    std::istringstream lines(code);
    for (std::string line; std::getline(lines, line);) {
        if (line == ";LAYER_CHANGE") layers.emplace_back();
        if (layers.empty()) continue;
        if (line == ";TYPE:Custom") break;  // what ends the print
        if (line == ";TYPE:Overhang perimeter" || line == ";TYPE:Bridge infill") layers.back().hanging = true;
        const std::size_t e = line.find(" E");
        if (e == line.npos) continue;
        const double to = std::atof(line.c_str() + e + 2);
        if (line.starts_with("G1 X") && to > extruded) layers.back().mm2 += (to - extruded) * filament_mm2 / kLayerMm;
        extruded = to;
    }
    return layers;
}

TEST_CASE("printed layers: what PrusaSlicer prints fills what verify measures, and hangs where it does",
          "[cli][programs]") {
    const auto* const name = GENERATE("box", "islet", "bracket", "vase", "bunny");
    CAPTURE(name);
    if (std::string(name) == "bunny" && !std::filesystem::exists(kBunny)) return;
    const TemporaryFolder folder;
    const std::string model = model_in(folder, name), code = folder / "layers.gcode";
    if (!slicer_ran("prusa-slicer",
                    "-g -o " + code +
                        " --layer-height 0.3 --first-layer-height 0.3 --first-layer-extrusion-width 0.45 --skirts 0 "
                        "--fill-density 100% --fill-pattern rectilinear " +
                        model))
        return;
    const std::vector<PrintedArea> layers = printed_areas(slurp(code));
    const nlohmann::json print = measured(model);
    REQUIRE(layers.size() == print["layers"].get<std::size_t>());
    // Lines overlap and round the corners off: a tenth less or more.
    CHECK(layers[0].mm2 == Approx(print["first_layer_contact_mm2"].get<double>()).epsilon(0.1));
    double volume = 0.0;
    for (const PrintedArea& layer : layers) volume += kLayerMm * layer.mm2;
    CHECK(volume == Approx(print["material_mm3"].get<double>()).epsilon(0.1));
    const bool hangs = std::ranges::any_of(layers, &PrintedArea::hanging);
    const bool told = print["longest_bridge_mm"].get<double>() > 0.5 ||
                      print["longest_cantilever_mm"].get<double>() > 0.5 || print["islands"].get<int>() > 0;
    CHECK(hangs == told);
}

}  // namespace
}  // namespace fretwork::testing
