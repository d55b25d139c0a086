// Voxel data of a 3MF: what they say at a point, and what is refused.
#include <catch2/catch.hpp>
#include <random>
#include <string>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "formats/carved_threemf_writer.h"
#include "formats/png_writer.h"
#include "formats/threemf_reader.h"
#include "formats/volumetric_reader.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork {
namespace {

using testing::make_volumetric;
using testing::Volumetric;

/// Two by two by two cells of grey: a thousand, two thousand to the right, four below, five; the upper sheet has four
/// thousand more.
Volumetric cube() {
    Volumetric volumetric;
    volumetric.sheets = {write_png16(std::vector<std::uint16_t>{1000, 2000, 3000, 4000}, 2, 2, 1),
                         write_png16(std::vector<std::uint16_t>{5000, 6000, 7000, 8000}, 2, 2, 1)};
    volumetric.stack = "rowcount=\"2\" columncount=\"2\" sheetcount=\"2\"";
    return volumetric;
}

double value_at(const Volumetric& volumetric, const Vec3& point_mm) {
    const auto objects = read_volumetric_threemf(make_volumetric(volumetric), "p");
    return objects.at(0).property("fw:solid", point_mm).value() * 65535.0;
}

TEST_CASE("voxel data: the nearest cell, rows from the top, ties to the lower index", "[formats][threemf]") {
    Volumetric nearest = cube();
    nearest.function = "filter=\"nearest\"";
    CHECK(value_at(nearest, Vec3(0.25, 0.75, 0.25)) == Approx(1000));
    CHECK(value_at(nearest, Vec3(0.75, 0.75, 0.25)) == Approx(2000));
    CHECK(value_at(nearest, Vec3(0.25, 0.25, 0.25)) == Approx(3000));
    CHECK(value_at(nearest, Vec3(0.75, 0.25, 0.75)) == Approx(8000));
    CHECK(value_at(nearest, Vec3(0.5, 0.5, 0.5)) == Approx(1000));
}

TEST_CASE("voxel data: linear between the cells' centres unless said otherwise", "[formats][threemf]") {
    CHECK(value_at(cube(), Vec3(0.25, 0.75, 0.25)) == Approx(1000));
    CHECK(value_at(cube(), Vec3(0.5, 0.75, 0.25)) == Approx(1500));
    CHECK(value_at(cube(), Vec3(0.25, 0.625, 0.25)) == Approx(1500));  // a quarter of the way down to 3000
    CHECK(value_at(cube(), Vec3(0.5, 0.5, 0.5)) == Approx(4500));
}

TEST_CASE("voxel data: what lies beyond the box, by the tile style", "[formats][threemf]") {
    const auto beyond = [](const std::string& style, const std::string& filter, double u) {
        Volumetric volumetric = cube();
        volumetric.function = "filter=\"" + filter + "\"" + (style.empty() ? "" : " tilestyleu=\"" + style + "\"");
        return value_at(volumetric, Vec3(u, 0.75, 0.25));
    };
    for (const std::string wrap : {"", "wrap"}) {
        CHECK(beyond(wrap, "nearest", 1.25) == Approx(1000));
        CHECK(beyond(wrap, "nearest", -0.25) == Approx(2000));
        CHECK(beyond(wrap, "linear", 0.0) == Approx(1500));
    }
    CHECK(beyond("mirror", "nearest", 1.25) == Approx(2000));
    CHECK(beyond("mirror", "nearest", 2.25) == Approx(1000));
    CHECK(beyond("mirror", "linear", 0.0) == Approx(1000));
    CHECK(beyond("clamp", "nearest", 2.25) == Approx(2000));
    CHECK(beyond("clamp", "linear", -7.0) == Approx(1000));
}

TEST_CASE("voxel data: scale, offset, transform and unit", "[formats][threemf]") {
    Volumetric scaled = cube();
    scaled.function = "filter=\"nearest\" valuescale=\"2\" valueoffset=\"-0.5\"";
    CHECK(value_at(scaled, Vec3(0.25, 0.75, 0.25)) == Approx(2000 - 0.5 * 65535));
    Volumetric turned = cube();
    turned.function = "filter=\"nearest\"";
    // Rows of the matrix: x goes to v, y to w, z to u and half a cell further.
    turned.volume =
        "<v:property name=\"fw:solid\" required=\"true\" functionid=\"3\" channel=\"red\" transform=\"0 1 0 0 0 1 1 0 "
        "0 "
        "0.25 0 0\"/>";
    CHECK(value_at(turned, Vec3(0.75, 0.25, 0.1)) == Approx(1000));
    CHECK(value_at(turned, Vec3(0.75, 0.25, 0.5)) == Approx(2000));
    CHECK(value_at(turned, Vec3(0.25, 0.75, 0.1)) == Approx(7000));
    turned.model = "unit=\"inch\"";
    CHECK(value_at(turned, 25.4 * Vec3(0.25, 0.75, 0.1)) == Approx(7000));
}

TEST_CASE("voxel data: names as drafts of the specification spell them", "[formats][threemf]") {
    Volumetric drafted = cube();
    drafted.function = "filter=\"nearest\" scale=\"2\" offset=\"-0.5\"";
    CHECK(value_at(drafted, Vec3(0.25, 0.75, 0.25)) == Approx(2000 - 0.5 * 65535));
    drafted.image_attribute = "image3dID";
    CHECK(value_at(drafted, Vec3(0.25, 0.75, 0.25)) == Approx(2000 - 0.5 * 65535));
    drafted.function = "filter=\"nearest\" scale=\"2\" valuescale=\"1\"";
    CHECK(value_at(drafted, Vec3(0.25, 0.75, 0.25)) == Approx(1000));
}

TEST_CASE("voxel data: channels of a sheet, and colours within [0, 1]", "[formats][threemf]") {
    Volumetric volumetric;
    volumetric.sheets = {write_png16(std::vector<std::uint16_t>{100, 200, 300, 400}, 1, 1, 4)};
    volumetric.stack = "rowcount=\"1\" columncount=\"1\" sheetcount=\"1\"";
    volumetric.volume = "<v:color functionid=\"3\" channel=\"color\"/>";
    for (const std::string channel : {"red", "green", "blue", "alpha"})
        volumetric.volume +=
            "<v:property name=\"fw:" + channel + "\" required=\"false\" functionid=\"3\" channel=\"" + channel + "\"/>";
    volumetric.function = "valuescale=\"300\"";
    const auto objects = read_volumetric_threemf(make_volumetric(volumetric), "p");
    const Vec3 middle(0.5, 0.5, 0.5);
    double expected = 100;
    for (const std::string channel : {"red", "green", "blue", "alpha"}) {
        CHECK(objects.at(0).property("fw:" + channel, middle).value() == Approx(300 * expected / 65535));
        expected += 100;
    }
    CHECK(objects[0].color(middle).value().x() == Approx(300 * 100 / 65535.0));
    CHECK(objects[0].color(middle).value().z() == 1.0);
    CHECK_FALSE(objects[0].property("fw:none", middle));
}

TEST_CASE("voxel data: only a mesh that names them with the prefix has them", "[formats][threemf]") {
    Volumetric plain = cube();
    plain.mesh = "volumeid=\"4\"";
    CHECK(read_volumetric_threemf(make_volumetric(plain), "p").empty());
}

TEST_CASE("voxel data: mistakes are named, and the mesh is there without them", "[formats][threemf][errors]") {
    const std::string property = cube().volume;
    const auto with = [](const auto& change) {
        Volumetric volumetric = cube();
        change(volumetric);
        return volumetric;
    };
    const auto with_volume = [&](const std::string& volume) { return with([&](Volumetric& v) { v.volume = volume; }); };
    const std::string other_size = write_png16(std::vector<std::uint16_t>(6, 0), 3, 2, 1);
    const std::string other_kind = write_png_gray8(std::vector<std::uint8_t>(4, 0), 2, 2);
    struct Mistake {
        Volumetric volumetric;
        std::string found;
        bool of_the_model;  ///< of the text, so that the mesh cannot be read either
    };
    const std::vector<Mistake> mistakes = {
        {with([](Volumetric& v) { v.sheets[1].clear(); }), "no sheet \"/3D/v/1.png\"", false},
        {with([&](Volumetric& v) { v.sheets[1] = other_size; }), "of 3 x 2", false},
        {with([&](Volumetric& v) { v.sheets[1] = other_kind; }), "another layout", false},
        {with([](Volumetric& v) { v.sheets[1] = "no picture"; }), "3D/v/1.png", false},
        {with([](Volumetric& v) { v.sheets[1].resize(60); }), "3D/v/1.png", false},
        {with([](Volumetric& v) { v.stack = "rowcount=\"3\" columncount=\"2\" sheetcount=\"2\""; }), "2 x 2", false},
        {with([](Volumetric& v) { v.stack = "rowcount=\"2\" columncount=\"2\" sheetcount=\"3\""; }), "2 sheets", true},
        {with([](Volumetric& v) { v.stack = "rowcount=\"2\" columncount=\"2\" sheetcount=\"1\""; }), "more sheets",
         true},
        {with([](Volumetric& v) { v.stack = "rowcount=\"2\" columncount=\"0\" sheetcount=\"2\""; }), "columncount",
         true},
        {with([](Volumetric& v) { v.stack = "rowcount=\"1025\" columncount=\"2\" sheetcount=\"2\""; }), "rowcount",
         true},
        {with([](Volumetric& v) { v.stack = "rowcount=\"2\" columncount=\"2\" sheetcount=\"4294967298\""; }),
         "sheetcount", true},
        {with([](Volumetric& v) { v.function = "filter=\"cubic\""; }), "cubic", true},
        {with([](Volumetric& v) { v.function = "tilestylew=\"repeat\""; }), "repeat", true},
        {with([](Volumetric& v) { v.function = "valuescale=\"nan\""; }), "valuescale", true},
        {with_volume("<v:property name=\"fw:solid\" functionid=\"3\" channel=\"opacity\"/>"), "opacity", false},
        {with_volume("<v:property name=\"fw:solid\" functionid=\"3\" channel=\"color\"/>"), "color", false},
        {with_volume("<v:color functionid=\"3\" channel=\"alpha\"/>"), "alpha", false},
        {with_volume("<v:property name=\"solid\" functionid=\"3\" channel=\"red\"/>"), "\"solid\"", false},
        {with_volume("<v:property name=\"fw:solid\" functionid=\"9\" channel=\"red\"/>"), "id 9", false},
        {with_volume(property + property), "second property", false},
        {with_volume("<v:color functionid=\"3\" channel=\"color\" transform=\"1 0 0 0 1 0 0 0 0 0 0 0\"/>"), "singular",
         true},
        {with([](Volumetric& v) { v.mesh = "v:volumeid=\"9\""; }), "id 9", false},
    };
    for (const Mistake& mistake : mistakes) {
        CAPTURE(mistake.found);
        const std::string bytes = make_volumetric(mistake.volumetric);
        CHECK_THROWS_AS(read_volumetric_threemf(bytes, "p.3mf"), InvalidInput);
        CHECK_THROWS_WITH(read_volumetric_threemf(bytes, "p.3mf"),
                          Catch::StartsWith("p.3mf: ") && Catch::Contains(mistake.found));
        CHECK_THROWS_WITH(read_threemf_with_volumes(bytes, "p.3mf"), Catch::Contains(mistake.found));
        if (mistake.of_the_model)
            CHECK_THROWS_WITH(read_threemf(bytes, "p.3mf"), Catch::Contains(mistake.found));
        else
            CHECK(read_threemf(bytes, "p.3mf").mesh.triangles.size() == 4);
    }
    CHECK_THROWS_WITH(read_volumetric_threemf(make_volumetric(cube()), "p", 7), Catch::Contains("over 7 samples"));
    CHECK(read_volumetric_threemf(make_volumetric(cube()), "p", 512).size() == 1);
}

TEST_CASE("voxel data: much announced and little there is refused before it fills memory",
          "[formats][threemf][errors]") {
    // Sheets of a million pixels that pack to a few kilobytes; with all of them there would be over 2^30 samples.
    const std::string sheet = write_png16(std::vector<std::uint16_t>(std::size_t{4} << 20, 0), 1024, 1024, 4);
    Volumetric volumetric;
    volumetric.sheets.assign(257, sheet);
    volumetric.stack = "rowcount=\"1024\" columncount=\"1024\" sheetcount=\"257\"";
    CHECK_THROWS_WITH(read_volumetric_threemf(make_volumetric(volumetric), "p"), Catch::Contains("1073741824"));
}

TEST_CASE("voxel data: read together with the mesh they are the same, on any number of threads",
          "[formats][threemf][determinism]") {
    const TriangleMesh mesh = testing::make_box(Vec3(0, 0, 0), Vec3(7, 5, 6), {3, 3, 3});
    std::mt19937 random(5);
    SurfaceVoxels shell;
    shell.grid.extent = {17, 9, 40};
    SolidStates solid;
    std::vector<std::uint8_t> reinforced;
    std::vector<Rgb8> voxel_colors, colors;
    for (std::int32_t z = 0; z < 40; ++z)
        for (std::int32_t x = 0; x < 17; x += 1 + static_cast<std::int32_t>(random() % 3)) {
            shell.coords.push_back({x, static_cast<std::int32_t>(random() % 9), z});
            solid.push_back(random() % 2 == 0 ? SolidState::kSolid : SolidState::kEmpty);
            reinforced.push_back(random() % 2);
            voxel_colors.push_back({static_cast<std::uint8_t>(random()), 1, static_cast<std::uint8_t>(random())});
        }
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
        colors.push_back({static_cast<std::uint8_t>(t), 50, static_cast<std::uint8_t>(random())});
    const VoxelData data{shell, solid, reinforced, voxel_colors};
    CarvedPackage package;
    package.objects.push_back({mesh, colors, "box", &data});
    const std::string bytes = write_carved_threemf(package);
    const MeshFile alone = read_threemf(bytes, "p");
    for (const int threads : {1, 4}) {
        const ThreadLimit limit(threads);
        const VolumetricFile both = read_threemf_with_volumes(bytes, "p");
        CHECK(both.mesh.mesh.positions_mm == alone.mesh.positions_mm);
        CHECK(both.mesh.mesh.triangles == alone.mesh.triangles);
        CHECK(both.mesh.triangle_colors == colors);
        REQUIRE(both.objects.size() == 1);
        for (std::size_t v = 0; v < shell.size(); ++v) {
            const Vec3 center = shell.grid.center_mm(shell.coords[v]);
            // Of two entries in one cell either may speak.
            const bool alone_there = std::ranges::count(shell.coords, shell.coords[v]) == 1;
            if (!alone_there) continue;
            CHECK(both.objects[0].property("fw:solid", center) == (solid[v] == SolidState::kSolid ? 1.0 : 0.0));
            CHECK(both.objects[0].property("fw:reinforced", center) == (reinforced[v] != 0 ? 1.0 : 0.0));
        }
    }
}

}  // namespace
}  // namespace fretwork
