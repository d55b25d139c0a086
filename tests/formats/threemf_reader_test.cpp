// 3MF packages in: what the build shows, and what must be refused at once.
#include "formats/threemf_reader.h"

#include <sys/resource.h>

#include <catch2/catch.hpp>
#include <ctime>
#include <string>

#include "core/base/error.h"
#include "formats/png_writer.h"
#include "support/make_meshes.h"
#include "support/make_packages.h"

namespace fretwork {
namespace {

using testing::make_model;
using testing::make_package;
using testing::make_tetrahedron;
using testing::make_zip;
using testing::make_zip_bomb;
using testing::patched;
using testing::volume_mm3;
using testing::with_central_field;

MeshFile read(const std::string& bytes) {
    return read_threemf(bytes, "part.3mf");
}

MeshFile read_model_text(const std::string& resources, const std::string& build, const std::string& attributes = "") {
    return read(make_package(make_model(resources, build, attributes)));
}

TEST_CASE("3mf: units become millimetres", "[formats][threemf]") {
    const auto [name, mm] = GENERATE(table<std::string, double>({{"micron", 0.001},
                                                                 {"millimeter", 1.0},
                                                                 {"centimeter", 10.0},
                                                                 {"inch", 25.4},
                                                                 {"foot", 304.8},
                                                                 {"meter", 1000.0}}));
    const MeshFile file = read_model_text(make_tetrahedron(1), "<item objectid=\"1\"/>", "unit=\"" + name + "\"");
    CHECK(volume_mm3(file.mesh) == Approx(mm * mm * mm / 6));
}

TEST_CASE("3mf: components and items are placed by their transforms, outermost last", "[formats][threemf]") {
    // The component turns x to y and moves by (10, 0, 0); the item doubles and moves by (0, 0, 5).
    const std::string resources =
        make_tetrahedron(1, "name=\"tip\"") +
        "<object id=\"2\" name=\"pair\"><components><component objectid=\"1\" transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/>"
        "<component objectid=\"1\"/></components></object>";
    const MeshFile file = read_model_text(
        resources, "<item objectid=\"2\" transform=\"2 0 0 0 2 0 0 0 2 0 0 5\"/><item objectid=\"1\"/>");
    REQUIRE(file.mesh.positions_mm.size() == 12);
    CHECK((file.mesh.positions_mm[1] - Vec3(20, 2, 5)).norm() < 1e-12);  // (1,0,0) -> (10,1,0) -> (20,2,5)
    CHECK((file.mesh.positions_mm[2] - Vec3(18, 0, 5)).norm() < 1e-12);  // (0,1,0) -> (9,0,0) -> (18,0,5)
    CHECK(volume_mm3(file.mesh) == Approx((8 + 8 + 1) / 6.0));
    REQUIRE(file.parts.size() == 2);
    CHECK(file.parts[0].name == "pair");
    CHECK(file.parts[1].name == "tip");
    CHECK(file.parts[1].first_triangle == 8);
}

TEST_CASE("3mf: a mirroring transform keeps triangles facing outward", "[formats][threemf]") {
    const MeshFile file =
        read_model_text(make_tetrahedron(1), "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>");
    CHECK(volume_mm3(file.mesh) == Approx(1 / 6.0));
}

TEST_CASE("3mf: objects may come in any order and from other model parts", "[formats][threemf]") {
    const std::string other = make_model(make_tetrahedron(7), "");
    const std::string model = make_model(
        "<object id=\"2\"><components><component objectid=\"3\"/></components></object><object id=\"3\"><components>"
        "<component objectid=\"7\" p:path=\"/3D/Objects/other.model\"/></components></object>",
        "<item objectid=\"2\"/>", "requiredextensions=\"p\"");
    CHECK(volume_mm3(read(make_package(model, {{"3D/Objects/other.model", other}})).mesh) == Approx(1 / 6.0));
}

TEST_CASE("3mf: colours of groups and base materials, of triangles and of objects", "[formats][threemf]") {
    const std::string tables =
        "<basematerials id=\"8\"><base name=\"red\" displaycolor=\"#FF0000\"/></basematerials>"
        "<m:colorgroup id=\"9\"><m:color color=\"#000000\"/><m:color color=\"#FF00ff80\"/></m:colorgroup>";
    const MeshFile own =
        read_model_text(tables + make_tetrahedron(1, "", "pid=\"9\" p1=\"1\""), "<item objectid=\"1\"/>");
    CHECK(own.triangle_colors == std::vector<Rgb8>(4, Rgb8{255, 0, 255}));
    const MeshFile mixed = read_model_text(tables + make_tetrahedron(1, "", "pid=\"9\" p1=\"1\" p2=\"0\" p3=\"0\""),
                                           "<item objectid=\"1\"/>");
    CHECK(mixed.triangle_colors[2] == Rgb8{85, 0, 85});
    const MeshFile whole = read_model_text(tables + make_tetrahedron(1, "pid=\"8\" pindex=\"0\"") + make_tetrahedron(2),
                                           "<item objectid=\"2\"/><item objectid=\"1\"/>");
    REQUIRE(whole.triangle_colors.size() == 8);
    CHECK(whole.triangle_colors[7] == Rgb8{255, 0, 0});
    CHECK(whole.triangle_colors[0] != whole.triangle_colors[7]);
}

TEST_CASE("3mf: mixed materials and layers show one colour per triangle", "[formats][threemf]") {
    const std::string tables =
        "<basematerials id=\"8\"><base name=\"a\" displaycolor=\"#FF0000\"/><base name=\"b\" displaycolor=\"#0000FF\"/>"
        "</basematerials><m:compositematerials id=\"9\" matid=\"8\" matindices=\"0 1\"><m:composite values=\"1 3\"/>"
        "</m:compositematerials><m:colorgroup id=\"10\"><m:color color=\"#00FF0080\"/><m:color color=\"#808080\"/>"
        "</m:colorgroup><m:multiproperties id=\"11\" pids=\"8 10\"><m:multi pindices=\"0 0\"/><m:multi pindices=\"1\"/>"
        "</m:multiproperties><m:multiproperties id=\"12\" pids=\"8 10\" blendmethods=\"multiply\"><m:multi "
        "pindices=\"0 1\"/></m:multiproperties><m:compositematerials id=\"13\" matid=\"13\" matindices=\"0\">"
        "<m:composite values=\"1\"/></m:compositematerials>";
    const auto color_of = [&](const std::string& property) {
        const MeshFile file = read_model_text(tables + make_tetrahedron(1, "", property), "<item objectid=\"1\"/>");
        return file.triangle_colors.empty() ? Rgb8{} : file.triangle_colors[0];
    };
    CHECK(color_of("pid=\"9\" p1=\"0\"") == Rgb8{64, 0, 191});    // a quarter red, three quarters blue
    CHECK(color_of("pid=\"11\" p1=\"0\"") == Rgb8{127, 128, 0});  // green that covers 128/255 of red
    CHECK(color_of("pid=\"11\" p1=\"1\"") == Rgb8{0, 128, 127});  // the index left out is 0
    CHECK(color_of("pid=\"12\" p1=\"0\"") == Rgb8{128, 0, 0});    // half grey times red
    CHECK(color_of("pid=\"13\" p1=\"0\"") == Rgb8{});             // made of itself: of nothing
    // A triangle that names no group means that of its object.
    const MeshFile file =
        read_model_text(tables + make_tetrahedron(1, "pid=\"8\" pindex=\"0\"", "p1=\"1\""), "<item objectid=\"1\"/>");
    CHECK(file.triangle_colors[0] == Rgb8{0, 0, 255});
    CHECK_THROWS_WITH(color_of("pid=\"9\" p1=\"1\""), Catch::Contains("colour index 1"));
    CHECK_THROWS_WITH(color_of("pid=\"11\" p1=\"2\""), Catch::Contains("colour index 2"));
}

TEST_CASE("3mf: a texture gives the pixel in the middle of each triangle", "[formats][threemf]") {
    // Two by two pixels: red, green above blue, white. v = 0 is the lower edge.
    Image picture;
    picture.width = picture.height = 2;
    picture.pixels = {{255, 0, 0, 255}, {0, 255, 0, 255}, {0, 0, 255, 255}, {255, 255, 255, 255}};
    const auto colors_with = [&](const std::string& u, const std::string& v, const std::string& style,
                                 const std::string& png) {
        const std::string resources =
            "<m:texture2d id=\"5\" path=\"/3D/Textures/t.png\" contenttype=\"image/png\" tilestyleu=\"" + style +
            "\"/><m:texture2dgroup id=\"6\" texid=\"5\"><m:tex2coord u=\"" + u + "\" v=\"" + v +
            "\"/></m:texture2dgroup>" + make_tetrahedron(1, "", "pid=\"6\" p1=\"0\"");
        return read(make_package(make_model(resources, "<item objectid=\"1\"/>"), {{"3D/Textures/t.png", png}}));
    };
    const auto color_at = [&](const std::string& u, const std::string& v, const std::string& style = "wrap") {
        return colors_with(u, v, style, write_png(picture)).triangle_colors.at(0);
    };
    CHECK(color_at("0.25", "0.75") == Rgb8{255, 0, 0});
    CHECK(color_at("0.75", "0.75") == Rgb8{0, 255, 0});
    CHECK(color_at("0.25", "0.25") == Rgb8{0, 0, 255});
    CHECK(color_at("0.75", "0") == Rgb8{255, 255, 255});
    CHECK(color_at("1.25", "0.75") == Rgb8{255, 0, 0});
    CHECK(color_at("1.25", "0.75", "mirror") == Rgb8{0, 255, 0});
    CHECK(color_at("-3", "0.75", "clamp") == Rgb8{255, 0, 0});
    CHECK(color_at("9", "0.75", "none") == Rgb8{0, 255, 0});
    // A picture that cannot be read costs the colours, not the model.
    const MeshFile broken = colors_with("0", "0", "wrap", "no picture");
    CHECK(broken.triangle_colors.empty());
    REQUIRE(broken.warnings.size() == 2);
    CHECK_THAT(broken.warnings[1], Catch::Contains("t.png"));
}

TEST_CASE("3mf: support objects are left out, unknown elements skipped", "[formats][threemf]") {
    const MeshFile file =
        read_model_text(make_tetrahedron(1) + make_tetrahedron(2, "type=\"support\"") +
                            "<fw:thing id=\"1\"><object id=\"1\"><mesh/></object></fw:thing><texture2d id=\"5\"/>",
                        "<item objectid=\"1\"/><item objectid=\"2\"/>");
    CHECK(file.mesh.triangles.size() == 4);
    CHECK(file.warnings.size() == 1);
}

std::string nested_components(int levels, const std::string& leaf = make_tetrahedron(1)) {
    std::string xml = leaf;
    for (int i = 2; i <= levels; ++i) {
        const std::string below = "<component objectid=\"" + std::to_string(i - 1) + "\"/>";
        xml += "<object id=\"" + std::to_string(i) + "\"><components>" + below + below + "</components></object>\n";
    }
    return xml;
}

std::string long_chain(int levels) {
    std::string xml = make_tetrahedron(1);
    for (int i = 2; i <= levels; ++i)
        xml += "<object id=\"" + std::to_string(i) + "\"><components><component objectid=\"" + std::to_string(i - 1) +
               "\"/></components></object>\n";
    return xml;
}

std::string repeated(const std::string& text, std::size_t count) {
    std::string all;
    for (std::size_t i = 0; i < count; ++i) all += text;
    return all;
}

/// Different enough to keep to the packing ratio.
std::string many_items(unsigned count) {
    std::string items;
    for (unsigned i = 0; i < count; ++i)
        items += "<item objectid=\"" + std::to_string(1 + (i * 2654435761u) % 0x7FFFFFFF) + "\"/>";
    return items;
}

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kSanitized = true;
#else
constexpr bool kSanitized = false;
#endif

struct Hostile {
    std::string name;
    std::string bytes;
    std::string message;  ///< what the refusal must say
};

std::vector<Hostile> hostile_packages() {
    const std::string item = "<item objectid=\"1\"/>";
    const auto model = [&](const std::string& resources) { return make_package(make_model(resources, item)); };
    const auto with_vertex = [&](const std::string& x) {
        return model("<object id=\"1\"><mesh><vertices><vertex x=\"" + x +
                     "\" y=\"0\" z=\"0\"/><vertex x=\"1\" y=\"0\" z=\"0\"/><vertex x=\"0\" y=\"1\" z=\"0\"/></vertices>"
                     "<triangles><triangle v1=\"0\" v2=\"1\" v3=\"2\"/></triangles></mesh></object>");
    };
    const auto with_index = [&](const std::string& index) {
        return model(
            "<object id=\"1\"><mesh><vertices><vertex x=\"0\" y=\"0\" z=\"0\"/></vertices><triangles><triangle "
            "v1=\"0\" v2=\"" +
            index + "\" v3=\"2\"/></triangles></mesh></object>");
    };
    const auto with_transform = [&](const std::string& numbers) {
        return make_package(make_model(make_tetrahedron(1), "<item objectid=\"1\" transform=\"" + numbers + "\"/>"));
    };
    const auto with_name = [&](const std::string& name) {
        const std::string stand_in(name.size(), 'Q');
        return patched(make_package(make_model(make_tetrahedron(1), item), {{stand_in, "x"}}), stand_in, name);
    };
    const std::string laughs =
        "<?xml version=\"1.0\"?><!DOCTYPE m [<!ENTITY a \"ha\"><!ENTITY b \"&a;&a;&a;&a;&a;&a;&a;&a;\">]>"
        "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\"><metadata>&b;</metadata></model>";
    const std::string outside = "<?xml version=\"1.0\"?><!DOCTYPE m SYSTEM \"file:///etc/passwd\"><model/>";
    const std::string good = make_package(make_model(make_tetrahedron(1), item));
    constexpr std::size_t kUnixLink = 0120777u;
    return {
        {"empty", "", "ZIP"},
        {"entities", make_package(laughs), "document type"},
        {"external", make_package(outside), "document type"},
        {"nan", with_vertex("nan"), "x \"nan\""},
        {"infinite", with_vertex("1e400"), "x \"1e400\""},
        {"huge", with_vertex("1e38"), "1e9"},
        {"not a number", with_vertex("0x10"), "x \"0x10\""},
        {"index past the end", with_index("1"), "vertex index 1"},
        {"negative index", with_index("-1"), "\"-1\""},
        {"wrapped index", with_index("4294967297"), "\"4294967297\""},
        {"overlong index", with_index("18446744073709551617"), "\"18446744073709551617\""},
        {"cycle",
         model("<object id=\"1\"><components><component objectid=\"2\"/></components></object>"
               "<object id=\"2\"><components><component objectid=\"1\"/></components></object>"),
         "within itself"},
        {"self", model("<object id=\"1\"><components><component objectid=\"1\"/></components></object>"),
         "within itself"},
        {"doubling tree", make_package(make_model(nested_components(31), "<item objectid=\"31\"/>")), "placed meshes"},
        {"doubling tree of nothing",
         make_package(
             make_model(nested_components(31, "<object id=\"1\"><components/></object>"), "<item objectid=\"31\"/>")),
         "placed objects"},
        {"deep", make_package(make_model(nested_components(40), "<item objectid=\"40\"/>")), "32 levels"},
        {"deep behind shallow",
         make_package(make_model(long_chain(20000),
                                 [] {
                                     std::string items;
                                     for (int i = 1; i <= 20000; ++i)
                                         items += "<item objectid=\"" + std::to_string(i) + "\"/>";
                                     return items;
                                 }())),
         "32 levels"},
        {"build bomb", make_package(make_model(make_tetrahedron(1), repeated(item, 20000))), "placed meshes"},
        {"too many items", make_package(make_model(make_tetrahedron(1), many_items(70000))), "65536"},
        {"missing object", make_package(make_model(make_tetrahedron(1), "<item objectid=\"2\"/>")), "object 2"},
        {"missing part", make_package(make_model("", "<item objectid=\"2\" p:path=\"/3D/none.model\"/>")),
         "3D/none.model"},
        {"repeated id", model(make_tetrahedron(1) + make_tetrahedron(1)), "second resource"},
        {"empty build", make_package(make_model(make_tetrahedron(1), "")), "empty build"},
        {"singular", with_transform("1 0 0 0 1 0 0 0 0 0 0 0"), "singular"},
        {"nan transform", with_transform("nan 0 0 0 1 0 0 0 1 0 0 0"), "\"nan\""},
        {"short transform", with_transform("1 0 0 0 1 0 0 0 1 0 0"), "twelve numbers"},
        {"unknown required extension",
         make_package(
             make_model(make_tetrahedron(1), item, "requiredextensions=\"z\" xmlns:z=\"http://example.com/unknown\"")),
         "example.com/unknown"},
        {"unknown unit", make_package(make_model(make_tetrahedron(1), item, "unit=\"parsec\"")), "parsec"},
        {"not well-formed", make_package("<model><resources></model>"), "found"},
        {"not a model", make_package("<html/>"), "html"},
        {"cut off XML", make_package(make_model(make_tetrahedron(1), item).substr(0, 500)), "well-formed"},
        {"nesting", make_package(repeated("<a>", 100000)), "found"},
        {"overlong attribute",
         make_package(make_model(
             "<object id=\"1\" name=\"" +
                 [] {
                     std::string name;  // Random enough to keep to the packing ratio.
                     for (unsigned i = 0; name.size() < 200000; ++i) name += std::to_string(i * 2654435761u);
                     return name;
                 }() +
                 "\"/>",
             item)),
         "64 KiB"},
        {"ratio bomb", make_zip_bomb(200), "ratio"},
        {"parent folder", with_name("../../../../tmp/evil"), "leaves its folder"},
        {"absolute", with_name("/tmp/evil/file"), "absolute"},
        {"drive", with_name("C:/evil/file"), "drive"},
        {"backslash", with_name("..\\..\\evil"), "backslash"},
        {"repeated entry", with_name("3D/3DMODEL.model"), "second entry"},
        {"no model", make_zip({{"readme.txt", "nothing"}}), "no model part"},
        {"symbolic link", with_central_field(with_central_field(good, 38, kUnixLink << 16, 4), 5, 3, 1),
         "symbolic link"},
        {"encrypted", with_central_field(good, 8, 1, 2), "encrypted"},
        {"strange method", with_central_field(good, 10, 99, 2), "found"},
        {"size lies low", with_central_field(good, 24, 10, 4), "found"},
        {"size lies high", with_central_field(good, 24, 0x7FFFFFFF, 4), "ratio"},
        {"cut off", good.substr(0, good.size() / 2), "broken archive"},
    };
}

TEST_CASE("3mf: hostile packages are refused within a second and 200 MB, by name", "[formats][threemf][errors]") {
    for (const Hostile& hostile : hostile_packages()) {
        CAPTURE(hostile.name);
        rusage before{};
        getrusage(RUSAGE_SELF, &before);
        const std::clock_t start = std::clock();
        CHECK_THROWS_AS(read(hostile.bytes), InvalidInput);
        const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
        CHECK_THROWS_WITH(read(hostile.bytes), Catch::StartsWith("part.3mf: ") && Catch::Contains(hostile.message));
        rusage after{};
        getrusage(RUSAGE_SELF, &after);
        // Sanitizers keep freed memory and take their time.
        if (kSanitized) continue;
        CHECK(seconds < 1.0);
        CHECK(after.ru_maxrss - before.ru_maxrss < 200 * 1024);
    }
}

TEST_CASE("3mf: a required extension is named in full, by its specification's name where it has one",
          "[formats][threemf][errors]") {
    const auto required = [](const std::string& space) {
        return make_package(make_model(make_tetrahedron(1), "<item objectid=\"1\"/>",
                                       "requiredextensions=\"b\" xmlns:b=\"" + space + "\""));
    };
    const std::string lattice = "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02";
    CHECK_THROWS_WITH(read(required(lattice)), Catch::Contains("extension \"b\" (beam lattice, \"" + lattice + "\")") &&
                                                   Catch::Contains("--ignore-required"));
    CHECK_THROWS_WITH(read(required("urn:odd")), Catch::Contains("extension \"b\" (\"urn:odd\")"));
    const MeshFile let = read_threemf(required(lattice), "part.3mf", {}, {.ignore_required = true});
    CHECK(let.mesh.triangles.size() == 4);
    REQUIRE_FALSE(let.warnings.empty());
    CHECK_THAT(let.warnings[0], Catch::Contains("beam lattice"));
}

TEST_CASE("3mf: damage at any byte is refused or harmless", "[formats][threemf][errors]") {
    const std::string good = make_package(make_model(make_tetrahedron(1, "name=\"x\""), "<item objectid=\"1\"/>"));
    for (std::size_t at = 0; at < good.size(); ++at) {
        std::string bad = good;
        bad[at] = static_cast<char>(bad[at] ^ 0x55);
        try {
            const MeshFile file = read(bad);
            CHECK(file.mesh.triangles.size() == 4);
        } catch (const InvalidInput& refused) {
            CHECK_THAT(refused.what(), Catch::StartsWith("part.3mf: "));
        }
    }
}

}  // namespace
}  // namespace fretwork
