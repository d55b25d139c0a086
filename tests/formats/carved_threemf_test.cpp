// Carved 3MF packages out: what stands in them, and that the voxel stacks say what the voxels are.
#include "formats/carved_threemf_writer.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <regex>
#include <set>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "formats/png_reader.h"
#include "formats/threemf_reader.h"
#include "formats/volumetric_reader.h"
#include "formats/zip_reader.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::make_box;
using testing::make_icosphere;

std::uint64_t random_bits(std::uint64_t seed, std::size_t item, std::uint32_t draw) {
    return counter_random(seed, RandomStream::kTest, 5, item, draw);
}

/// Random cells of a grid whose sides differ, sorted as a shell's are, some of them holding two sheets.
struct RandomShell {
    SurfaceVoxels shell;
    SolidStates solid;
    std::vector<std::uint8_t> reinforced;
    std::vector<Rgb8> colors;

    explicit RandomShell(std::uint64_t seed) {
        shell.grid.origin_mm = Vec3(-3.25, 10.0, 0.125);
        shell.grid.voxel_mm = 0.3;
        shell.grid.extent = {7, 5, 6};
        std::size_t cell = 0;
        for (std::int32_t z = 0; z < 6; ++z)
            for (std::int32_t y = 0; y < 5; ++y)
                for (std::int32_t x = 0; x < 7; ++x, ++cell)
                    for (std::uint64_t sheets = random_bits(seed, cell, 0) % 3; sheets > 0; --sheets)
                        shell.coords.push_back({x, y, z});
        for (std::size_t v = 0; v < shell.size(); ++v) {
            solid.push_back(random_bits(seed, v, 1) % 2 == 0 ? SolidState::kEmpty : SolidState::kSolid);
            reinforced.push_back(random_bits(seed, v, 2) % 4 == 0 ? 1 : 0);
            const std::uint64_t bits = random_bits(seed, v, 3);
            colors.push_back({static_cast<std::uint8_t>(1 + bits % 255), static_cast<std::uint8_t>(bits >> 8 & 0xFF),
                              static_cast<std::uint8_t>(bits >> 16 & 0xFF)});
        }
    }
    [[nodiscard]] VoxelData data() const { return {shell, solid, reinforced, colors}; }
};

double linear(std::uint8_t srgb) {
    const double s = srgb / 255.0;
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

std::string package_of(const TriangleMesh& mesh, const std::vector<Rgb8>& colors, const VoxelData* voxels) {
    CarvedPackage package;
    package.objects.push_back({mesh, colors, "a <part> & \"more\"", voxels});
    package.title = "Vase, 2 \xC2\xB5m";
    package.metadata = {{"fw:seed", "42"}, {"Designer", "x < y"}};
    package.spec_toml = "[shell]\nthickness_mm = 2.0\n";
    package.report_json = "{\"version\": \"0.1\"}";
    package.thumbnail_png = "not really a PNG";
    return write_carved_threemf(package);
}

std::string model_of(const std::string& bytes) {
    return ZipReader(bytes, "p").read("3D/3dmodel.model", 1 << 26);
}

TEST_CASE("carved 3MF: every voxel of the shell is found at its place in the stack", "[formats][threemf][property]") {
    const auto seed = GENERATE(range<std::uint64_t>(1, 5));
    CAPTURE(seed);
    const RandomShell random(seed);
    const VoxelData data = random.data();
    const TriangleMesh mesh = make_box(Vec3(-3, 10, 0), Vec3(-1, 11, 2));
    const auto objects = read_volumetric_threemf(package_of(mesh, {}, &data), "p");
    REQUIRE(objects.size() == 1);
    CHECK(objects[0].name() == "a <part> & \"more\"");
    CHECK(objects[0].properties() == std::vector<std::string>{"fw:reinforced", "fw:solid"});

    // What each cell should say: solid and reinforced if one of its sheets is, the colour of the first solid one.
    const SurfaceVoxels& shell = random.shell;
    std::size_t v = 0;
    for (std::int32_t z = 0; z < 6; ++z)
        for (std::int32_t y = 0; y < 5; ++y)
            for (std::int32_t x = 0; x < 7; ++x) {
                double solid = 0.0, reinforced = 0.0;
                Rgb8 color{};
                for (bool first = true; v < shell.size() && shell.coords[v] == VoxelCoord{x, y, z};
                     ++v, first = false) {
                    const bool is_solid = random.solid[v] == SolidState::kSolid;
                    if (first || (is_solid && solid == 0.0)) color = random.colors[v];
                    if (is_solid) solid = 1.0;
                    if (random.reinforced[v] != 0) reinforced = 1.0;
                }
                CAPTURE(x, y, z);
                // The whole cell answers alike: its centre and points near two opposite corners.
                for (const double offset : {0.0, 0.45, -0.45}) {
                    const Vec3 p = shell.grid.center_mm({x, y, z}) + offset * shell.grid.voxel_mm * Vec3(1, 1, 1);
                    CHECK(objects[0].property("fw:solid", p) == solid);
                    CHECK(objects[0].property("fw:reinforced", p) == reinforced);
                    const auto sampled = objects[0].color(p);
                    REQUIRE(sampled.has_value());
                    for (std::size_t k = 0; k < 3; ++k)  // Half a step of 16 bits.
                        CHECK((*sampled)[static_cast<int>(k)] ==
                              Approx(solid > 0 || color != Rgb8{} ? linear(color[k]) : 0.0).margin(0.51 / 65535));
                }
            }
    CHECK(v == shell.size());
}

TEST_CASE("carved 3MF: outside of the grid the nearest cell answers", "[formats][threemf]") {
    const RandomShell random(2);
    const VoxelData data = random.data();
    const auto objects = read_volumetric_threemf(package_of(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), {}, &data), "p");
    const VoxelGrid& grid = random.shell.grid;
    const Vec3 top = grid.center_mm({6, 4, 5});
    CHECK(objects.at(0).property("fw:solid", top + Vec3(50, 60, 70)) == objects[0].property("fw:solid", top));
    const Vec3 low = grid.center_mm({0, 0, 0});
    CHECK(objects.at(0).property("fw:solid", low - Vec3(50, 60, 70)) == objects[0].property("fw:solid", low));
    CHECK(!objects[0].property("fw:stress", low).has_value());
}

TEST_CASE("carved 3MF: sheets are 16-bit RGBA with row 0 at the highest y", "[formats][threemf]") {
    SurfaceVoxels shell;
    shell.grid.extent = {3, 4, 2};
    shell.coords = {{2, 0, 1}};
    const SolidStates solid = {SolidState::kSolid};
    const std::vector<Rgb8> colors = {{255, 0, 128}};
    const VoxelData data{shell, solid, {}, colors};
    const std::string bytes = package_of(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), {}, &data);
    const ZipReader zip(bytes, "p");
    const RawPng png = read_raw_png(zip.read("3D/volumetric/voxels/sheet0001.png", 1 << 20), "sheet");
    REQUIRE(png.width == 3);
    REQUIRE(png.height == 4);
    CHECK(png.bits == 16);
    CHECK(png.channels == 4);
    const std::size_t at = 4 * (3 * 3 + 2);  // Last row, last column.
    CHECK(png.samples[at] == 65535);
    CHECK(png.samples[at + 1] == 0);
    CHECK(png.samples[at + 2] == std::lround(65535 * linear(128)));
    CHECK(png.samples[at + 3] == 65535);
    CHECK(std::count(png.samples.begin(), png.samples.end(), 0) == 3 * 4 * 4 - 3);
    CHECK(!zip.contains("3D/volumetric/reinforced/sheet0000.png"));
}

TEST_CASE("carved 3MF: the model part keeps to what slicers and lib3mf need", "[formats][threemf]") {
    const TriangleMesh mesh = make_icosphere(5.0, 1);
    std::vector<Rgb8> colors(mesh.triangles.size(), Rgb8{200, 50, 50});
    colors[3] = {50, 100, 200};
    const RandomShell random(1);
    const VoxelData data = random.data();
    const std::string xml = model_of(package_of(mesh, colors, &data));
    CHECK_THAT(xml, Catch::Contains("recommendedextensions=\"m v\"") && !Catch::Contains("requiredextensions"));
    CHECK_THAT(xml, Catch::Contains("<m:colorgroup id=\"1\"><m:color color=\"#3264C8\"/><m:color color=\"#C83232\"/>"
                                    "</m:colorgroup>"));
    CHECK_THAT(
        xml, Catch::Contains("type=\"model\" name=\"a &lt;part&gt; &amp; &quot;more&quot;\" pid=\"1\" pindex=\"0\"") &&
                 Catch::Contains("<mesh v:volumeid=\"6\">"));
    CHECK_THAT(xml, Catch::Contains("filter=\"nearest\"") && Catch::Contains("tilestyleu=\"clamp\"") &&
                        Catch::Contains("tilestylev=\"clamp\"") && Catch::Contains("tilestylew=\"clamp\""));
    CHECK_THAT(xml, Catch::Contains("<v:property name=\"fw:solid\" required=\"true\""));
    CHECK_THAT(xml, Catch::Contains("rowcount=\"5\" columncount=\"7\" sheetcount=\"6\""));
    // Twelve numbers with single blanks between them, in each of the three that there are.
    const std::regex transform(" transform=\"(-?[0-9.e+-]+ ){11}-?[0-9.e+-]+\"");
    CHECK(std::distance(std::sregex_iterator(xml.begin(), xml.end(), transform), {}) == 3);
    CHECK_THAT(xml, Catch::Contains("<v:color functionid=\"3\" channel=\"color\" transform="));
    CHECK_THAT(xml, Catch::Contains("<metadata name=\"Title\">Vase, 2 \xC2\xB5m</metadata>") &&
                        Catch::Contains("<metadata name=\"Designer\">x &lt; y</metadata>") &&
                        Catch::Contains("<metadata name=\"fw:seed\">42</metadata>"));

    // Every triangle names its colour three times.
    const std::regex triangle(
        "<triangle v1=\"\\d+\" v2=\"\\d+\" v3=\"\\d+\" pid=\"1\" p1=\"(\\d)\" p2=\"\\1\" p3=\"\\1\"/>");
    CHECK(static_cast<std::size_t>(std::distance(std::sregex_iterator(xml.begin(), xml.end(), triangle), {})) ==
          mesh.triangles.size());

    // Ids rise, and no reference points forward.
    const std::regex id("\\bid=\"(\\d+)\"");
    int last = 0;
    for (auto match = std::sregex_iterator(xml.begin(), xml.end(), id); match != std::sregex_iterator(); ++match) {
        CHECK(std::stoi((*match)[1]) == last + 1);
        last = std::stoi((*match)[1]);
    }
    CHECK(last == 7);
}

TEST_CASE("carved 3MF: every sheet is named by a relationship and every part has a type", "[formats][threemf]") {
    const RandomShell random(1);
    const VoxelData data = random.data();
    const std::string bytes = package_of(make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), {}, &data);
    const ZipReader zip(bytes, "p");
    const std::string relations = zip.read("3D/_rels/3dmodel.model.rels", 1 << 20);
    const std::string roots = zip.read("_rels/.rels", 1 << 20);
    const std::string types = zip.read("[Content_Types].xml", 1 << 20);
    std::size_t sheets = 0;
    for (const auto& entry : zip.entries()) {
        if (entry.name == "[Content_Types].xml") continue;
        CAPTURE(entry.name);
        const std::string extension = entry.name.substr(entry.name.rfind('.') + 1);
        CHECK_THAT(types, Catch::Contains("Extension=\"" + extension + "\""));
        if (entry.name.find("sheet") != std::string::npos) {
            ++sheets;
            CHECK_THAT(relations, Catch::Contains("Target=\"/" + entry.name +
                                                  "\" Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/"
                                                  "3dtexture\""));
        } else if (extension != "rels") {
            CHECK_THAT(roots, Catch::Contains("Target=\"/" + entry.name + "\""));
        }
    }
    CHECK(sheets == 12);
    CHECK_THAT(types, Catch::Contains("Extension=\"png\" ContentType=\"image/png\"") &&
                          Catch::Contains("Extension=\"model\" "
                                          "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\""));
    CHECK_THAT(roots, Catch::Contains("Target=\"/3D/3dmodel.model\" "
                                      "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"") &&
                          Catch::Contains("Target=\"/Metadata/thumbnail.png\" "
                                          "Type=\"http://schemas.openxmlformats.org/package/2006/relationships/"
                                          "metadata/thumbnail\""));
    CHECK(zip.read("Metadata/fretwork.toml", 1 << 20) == "[shell]\nthickness_mm = 2.0\n");
}

TEST_CASE("carved 3MF: several objects keep their own data", "[formats][threemf]") {
    const RandomShell first(1), second(2);
    const VoxelData a = first.data(), b = second.data();
    const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1)), ball = make_icosphere(3.0, 1);
    const std::vector<Rgb8> colors(ball.triangles.size(), Rgb8{9, 8, 7});
    CarvedPackage package;
    package.objects.push_back({box, {}, "box", &a});
    package.objects.push_back({ball, colors, "ball", &b});
    const std::string bytes = write_carved_threemf(package);
    const MeshFile file = read_threemf(bytes, "p");
    REQUIRE(file.parts.size() == 2);
    CHECK(file.parts[1].triangle_count == ball.triangles.size());
    CHECK(file.triangle_colors.back() == Rgb8{9, 8, 7});
    const auto objects = read_volumetric_threemf(bytes, "p");
    REQUIRE(objects.size() == 2);
    bool differ = false;
    for (std::int32_t x = 0; x < 7; ++x) {
        const Vec3 p = first.shell.grid.center_mm({x, 2, 3});
        differ = differ || objects[0].property("fw:solid", p) != objects[1].property("fw:solid", p);
    }
    CHECK(differ);
}

TEST_CASE("carved 3MF: extruders stand on triangles as slicers write them", "[formats][threemf]") {
    // The codes that PrusaSlicer 2.5 reads and writes for whole triangles.
    const std::vector<std::string> codes = {"4", "8", "0C", "1C", "2C", "3C", "4C"};
    for (std::size_t i = 0; i < codes.size(); ++i) CHECK(paint_state_text(static_cast<int>(i) + 1) == codes[i]);
    CHECK(paint_state_text(16) == "DC");
    CHECK_THROWS_AS(paint_state_text(17), InvalidInput);
    CHECK_THROWS_AS(paint_state_text(0), InvalidInput);

    const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1));
    std::vector<std::uint8_t> extruders(box.triangles.size(), 1);
    extruders[4] = 3;
    const auto painted = [&](PaintFormat format) {
        CarvedPackage package;
        package.objects.push_back({box, {}, "box", nullptr, nullptr, {format, extruders}});
        return model_of(write_carved_threemf(package));
    };
    CHECK_THAT(painted(PaintFormat::kPrusa),
               Catch::Contains("xmlns:slic3rpe=\"http://schemas.slic3r.org/3mf/2017/06\"") &&
                   Catch::Contains("<metadata name=\"slic3rpe:Version3mf\">1</metadata>") &&
                   Catch::Contains("<metadata name=\"slic3rpe:MmPaintingVersion\">1</metadata>") &&
                   Catch::Contains(" slic3rpe:mmu_segmentation=\"0C\"/>") && !Catch::Contains("paint_color"));
    CHECK_THAT(painted(PaintFormat::kBambu), Catch::Contains(" paint_color=\"0C\"/>") &&
                                                 Catch::Contains(" paint_color=\"4\"/>") &&
                                                 !Catch::Contains("slic3rpe"));
    CHECK_THAT(painted(PaintFormat::kNone), !Catch::Contains("slic3rpe") && !Catch::Contains("paint_color"));
    extruders.pop_back();
    CHECK_THROWS_WITH(painted(PaintFormat::kPrusa), Catch::Contains("11 extruders"));
}

TEST_CASE("carved 3MF: the bytes do not depend on threads or the time zone", "[formats][determinism]") {
    const RandomShell random(3);
    const VoxelData data = random.data();
    const TriangleMesh mesh = make_icosphere(5.0, 6);  // More triangles than one piece of the text holds.
    std::vector<Rgb8> colors(mesh.triangles.size());
    for (std::size_t t = 0; t < colors.size(); ++t) colors[t] = {static_cast<std::uint8_t>(t % 256), 7, 7};
    const std::string bytes = package_of(mesh, colors, &data);
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        CHECK(package_of(mesh, colors, &data) == bytes);
    }
    const char* old = std::getenv("TZ");
    const std::string kept = old != nullptr ? old : "";
    setenv("TZ", "Asia/Kathmandu", 1);
    tzset();
    CHECK(package_of(mesh, colors, &data) == bytes);
    old != nullptr ? setenv("TZ", kept.c_str(), 1) : unsetenv("TZ");
    tzset();
}

TEST_CASE("carved 3MF: what cannot be written is named", "[formats][errors]") {
    const RandomShell random(1);
    const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1));
    CHECK_THROWS_AS(write_carved_threemf({}), InvalidInput);
    const SolidStates few(3, SolidState::kSolid);
    const VoxelData wrong{random.shell, few};
    CHECK_THROWS_WITH(package_of(box, {}, &wrong), Catch::Contains("3 values of solid"));
    SurfaceVoxels outside = random.shell;
    outside.coords.back()[0] = 7;
    const VoxelData beyond{outside, random.solid};
    CHECK_THROWS_WITH(package_of(box, {}, &beyond), Catch::Contains("outside of the grid"));
    SurfaceVoxels large = random.shell;
    large.grid.extent[1] = 1025;
    const VoxelData too_large{large, random.solid};
    CHECK_THROWS_WITH(package_of(box, {}, &too_large), Catch::Contains("1025"));
    CarvedPackage named;
    named.objects.push_back({box});
    named.metadata = {{"Colour", "red"}};
    CHECK_THROWS_WITH(write_carved_threemf(named), Catch::Contains("Colour"));
}

TEST_CASE("carved 3MF: writing stops when asked and reports rising progress", "[formats][cancel]") {
    const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1));
    CarvedPackage package;
    package.objects.push_back({box});
    double last = 0.0;
    write_carved_threemf(package, RunControl([&](std::string_view, double fraction) {
                             CHECK(fraction >= last);
                             last = fraction;
                         }));
    CHECK(last == 1.0);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(write_carved_threemf(package, RunControl({}, source.get_token())), Cancelled);
}

}  // namespace
}  // namespace fretwork
