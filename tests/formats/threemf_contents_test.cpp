// What `info` tells of a package: all that is in it, also what nothing else looks at.
#include "formats/threemf_contents.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "formats/carved_threemf_writer.h"
#include "formats/facts_text.h"
#include "formats/slicer_paint.h"
#include "formats/threemf_facts.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork {
namespace {

using Json = nlohmann::json;
using testing::make_model;
using testing::make_package;
using testing::make_project;
using testing::make_tetrahedron;

const std::string kRoot = "3D/3dmodel.model", kOther = "3D/Objects/other.model";

ThreemfContents contents_of(const std::string& package) {
    return threemf_contents(threemf::Build(package, "p", {.ignore_required = true}, {}), package, "p");
}

TEST_CASE("3mf contents: parts, metadata and extensions of a project", "[formats][threemf][info]") {
    const ThreemfContents contents = contents_of(make_project());
    CHECK(contents.model_part == kRoot);
    CHECK(contents.thumbnail == "Metadata/thumbnail.png");
    REQUIRE(contents.parts.size() == 12);
    const auto type_of = [&](const std::string& path) {
        const auto part = std::ranges::find(contents.parts, path, &PackagePartInfo::path);
        REQUIRE(part != contents.parts.end());
        return part->content_type;
    };
    CHECK(type_of("odd/part.bin") == "urn:odd");
    CHECK(type_of(kRoot) == "application/vnd.ms-package.3dmanufacturing-3dmodel+xml");
    CHECK(type_of("3D/Textures/t.png") == "image/png");  // the package spells it PNG
    CHECK(type_of("Metadata/project_settings.config").empty());
    CHECK(contents.parts[2].bytes == 7);
    REQUIRE(contents.metadata.size() == 2);
    CHECK(contents.metadata[0].second == "A & B \xCE\xBC");
    REQUIRE(contents.extensions.size() == 2);
    CHECK(contents.extensions[0].required);
    CHECK(contents.extensions[0].understood);
    CHECK(contents.extensions[1].space == "urn:x");
    CHECK_FALSE(contents.extensions[1].required);
    CHECK_FALSE(contents.extensions[1].understood);
}

TEST_CASE("3mf contents: materials of every model part, paint and what is carried along", "[formats][threemf][info]") {
    const ThreemfContents contents = contents_of(make_project());
    REQUIRE(contents.materials.size() == 2);
    CHECK(contents.materials[0].part == kRoot);
    CHECK(contents.materials[0].kind == "basematerials");
    CHECK(contents.materials[0].id == 2);
    CHECK(contents.materials[0].first == std::vector<std::string>{"red #FF0000"});
    CHECK(contents.materials[1].part == kOther);
    CHECK(contents.materials[1].first == std::vector<std::string>{"#00FF00"});
    REQUIRE(contents.paint.size() == 3);
    using Extruders = std::map<int, std::size_t>;
    CHECK(contents.paint[0].attribute == "slic3rpe:mmu_segmentation");
    CHECK(contents.paint[0].triangles == 4);
    CHECK(contents.paint[0].extruders == Extruders{{2, 4}});
    CHECK(contents.paint[1].attribute == "paint_color");
    CHECK(contents.paint[1].extruders == Extruders{{1, 4}});
    CHECK(contents.paint[2].attribute == "paint_supports");
    CHECK(contents.paint[2].extruders.empty());
    // <x:unknown> with an object of the core in it, which is no object, and <x:tail>.
    REQUIRE(contents.carried.size() == 2);
    CHECK(contents.carried[0].name == "unknown");
    CHECK(contents.carried[1].name == "tail");
    CHECK(contents.carried[1].space == "urn:x");
}

TEST_CASE("3mf contents: what an unknown element holds belongs to it", "[formats][threemf][info]") {
    const ThreemfContents contents = contents_of(make_package(
        make_model("<q:box xmlns:q=\"urn:quartz\"><q:lid/><m:colorgroup id=\"9\"><m:color color=\"#000010\"/>"
                   "</m:colorgroup></q:box><q:box xmlns:q=\"urn:quartz\"/>" +
                       make_tetrahedron(1),
                   "<item objectid=\"1\"/>")));
    CHECK(contents.materials.empty());
    REQUIRE(contents.carried.size() == 1);
    CHECK(contents.carried[0].name == "box");
    CHECK(contents.carried[0].count == 2);
}

TEST_CASE("3mf contents: of long lists of colours the number and the first are told", "[formats][threemf][info]") {
    std::string colors;
    for (int i = 0; i < 40; ++i) colors += "<m:color color=\"#0000" + std::to_string(10 + i) + "\"/>";
    const ThreemfContents contents = contents_of(make_package(make_model(
        "<m:colorgroup id=\"9\">" + colors + "</m:colorgroup>" + make_tetrahedron(1), "<item objectid=\"1\"/>")));
    REQUIRE(contents.materials.size() == 1);
    CHECK(contents.materials[0].entries == 40);
    REQUIRE(contents.materials[0].first.size() == 16);
    CHECK(contents.materials[0].first.back() == "#000025");
}

TEST_CASE("3mf contents: a required extension that is not known is told, not refused", "[formats][threemf][info]") {
    const std::string package = make_package(make_model(make_tetrahedron(1), "<item objectid=\"1\"/>",
                                                        "xmlns:q=\"urn:quartz\" requiredextensions=\"q m\" "
                                                        "recommendedextensions=\"q\""));
    const ThreemfContents contents = contents_of(package);
    REQUIRE(contents.extensions.size() == 2);
    CHECK(contents.extensions[0].space == "urn:quartz");
    CHECK(contents.extensions[0].required);
    CHECK_FALSE(contents.extensions[0].understood);
    CHECK(contents.extensions[1].understood);
    CHECK_THROWS_AS(contents_of(package.substr(0, package.size() / 2)), InvalidInput);
}

TEST_CASE("3mf contents: voxel data of a carved object, with the size of its voxels", "[formats][threemf][info]") {
    const TriangleMesh box = testing::make_box(Vec3(0, 0, 0), Vec3(2, 2, 2));
    SurfaceVoxels shell;
    shell.grid.extent = {3, 4, 2};
    shell.grid.voxel_mm = 0.75;
    shell.coords = {{2, 0, 1}};
    const SolidStates solid = {SolidState::kSolid};
    const std::vector<std::uint8_t> reinforced = {1};
    const VoxelData voxels{shell, solid, reinforced, {}};
    CarvedPackage package;
    package.objects.push_back({box, {}, "lamp", &voxels});
    const ThreemfContents contents = contents_of(write_carved_threemf(package));
    CHECK(contents.image_sheets == 4);  // two of colour and solid, two of what was reinforced
    CHECK(std::ranges::none_of(contents.parts, [](const PackagePartInfo& p) { return p.path.ends_with(".png"); }));
    REQUIRE(contents.voxel_data.size() == 1);
    CHECK(contents.voxel_data[0].object_name == "lamp");
    REQUIRE(contents.voxel_data[0].properties.size() == 2);
    for (const VoxelPropertyInfo& p : contents.voxel_data[0].properties) {
        CAPTURE(p.name);
        CHECK(std::tuple(p.columns, p.rows, p.sheets) == std::tuple(3, 4, 2));
        for (int k = 0; k < 3; ++k) CHECK(p.voxel_mm[k] == Approx(0.75));
    }
    CHECK(contents.voxel_data[0].properties[0].name == "fw:solid");
    CHECK(contents.voxel_data[0].properties[1].name == "fw:reinforced");
}

TEST_CASE("3mf contents: voxels of a model in inches are told in millimetres", "[formats][threemf][info]") {
    std::string object = make_tetrahedron(7);
    object.insert(object.find("<mesh") + 5, " v:volumeid=\"3\"");
    const std::string package = make_package(
        make_model("<v:image3d id=\"1\" name=\"s\"><v:imagestack rowcount=\"5\" columncount=\"4\" sheetcount=\"1\">"
                   "<v:imagesheet path=\"/3D/s.png\"/></v:imagestack></v:image3d><v:functionfromimage3d id=\"2\" "
                   "image3did=\"1\"/><v:volumedata id=\"3\"><v:property name=\"fw:solid\" functionid=\"2\" "
                   "channel=\"A\" transform=\"0.5 0 0 0 0.25 0 0 0 1 0 0 0\"/></v:volumedata>" +
                       object,
                   "<item objectid=\"7\"/>", "unit=\"inch\""));
    const ThreemfContents contents = contents_of(package);
    REQUIRE(contents.voxel_data.size() == 1);
    const VoxelPropertyInfo& solid = contents.voxel_data[0].properties.at(0);
    // 2 x 4 x 1 inches of 4 x 5 x 1 voxels
    CHECK(solid.voxel_mm[0] == Approx(2 * 25.4 / 4));
    CHECK(solid.voxel_mm[1] == Approx(4 * 25.4 / 5));
    CHECK(solid.voxel_mm[2] == Approx(25.4));
}

TEST_CASE("3mf facts: a program finds all of it under `package`", "[formats][threemf][info]") {
    Facts facts;
    add_package_facts(contents_of(make_project()), facts);
    const Json package = Json::parse(facts_json(facts))["package"];
    CHECK(package["parts"].size() == 12);
    CHECK(package["extensions"][1]["understood"] == false);
    CHECK(package["materials"][0]["first"][0] == "red #FF0000");
    CHECK(package["paint"][0]["extruders"]["2"] == 4);
    CHECK(package["carried"][1]["element"] == "tail");
    CHECK(package["metadata"][1]["name"] == "x:note");
}

TEST_CASE("3mf facts: a report is told without its long lists", "[formats][threemf][info]") {
    Facts facts;
    add_run_facts(R"({"mesh": {"closed": true, "min_mm": [1, 2.5, 3]}, "iterations": [{"a": 1}], "warnings": ["w"],)"
                  R"( "printability": {"faults": [{"b": 1}], "layers": 7}})",
                  "carved.", facts);
    add_run_facts("no report", "carved.", facts);
    CHECK(facts_lines(facts) ==
          "carved.mesh.closed = true\ncarved.mesh.min_mm = [1.0,2.5,3.0]\ncarved.printability.layers = 7\n"
          "carved.warnings = [\"w\"]\n");
}

TEST_CASE("3mf paint: every extruder is read back", "[formats][threemf][info]") {
    for (int extruder = 1; extruder <= 16; ++extruder) CHECK(extruder_of(paint_state_text(extruder)) == extruder);
    for (const char* split : {"", "0", "3C1", "EC", "FC", "1D", "84"}) CHECK(extruder_of(split) == 0);
}

}  // namespace
}  // namespace fretwork
