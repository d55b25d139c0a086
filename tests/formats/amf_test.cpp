// AMF in and out: what the format says is what the mesh shows.
#include <catch2/catch.hpp>
#include <string>

#include "core/base/error.h"
#include "core/mesh/mesh_report.h"
#include "formats/amf_reader.h"
#include "formats/mesh_file.h"
#include "formats/zip_writer.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

std::string vertex(const std::string& x, const std::string& y, const std::string& z, const std::string& more = "") {
    return "<vertex><coordinates><x>" + x + "</x><y>" + y + "</y><z>" + z + "</z></coordinates>" + more + "</vertex>";
}

std::string triangle(int a, int b, int c, const std::string& more = "") {
    return "<triangle>" + more + "<v1>" + std::to_string(a) + "</v1><v2>" + std::to_string(b) + "</v2><v3>" +
           std::to_string(c) + "</v3></triangle>";
}

std::string color(double r, double g, double b) {
    return "<color><r>" + std::to_string(r) + "</r><g>" + std::to_string(g) + "</g><b>" + std::to_string(b) +
           "</b></color>";
}

/// A tetrahedron of volume 1/6 with a corner at the origin; `volume` goes into its volume element's tag.
std::string object(const std::string& id, const std::string& volume = "", const std::string& before = "",
                   const std::string& corner = "", const std::string& face = "", const std::string& in_volume = "") {
    return "<object id=\"" + id + "\">" + before + "<mesh><vertices>" + vertex("0", " 0 ", "0", corner) +
           vertex("1", "0", "0") + vertex("0", "1e0", "0") + vertex("0", "0", "+1") + "</vertices><volume" + volume +
           ">" + in_volume + triangle(0, 2, 1, face) + triangle(0, 1, 3) + triangle(1, 2, 3) + triangle(0, 3, 2) +
           "</volume></mesh></object>";
}

std::string amf(const std::string& body, const std::string& attributes = "") {
    return "<?xml version=\"1.0\"?>\n<amf" + attributes + ">" + body + "</amf>";
}

MeshFile read(const std::string& bytes) {
    return read_mesh(bytes, MeshFormat::kAmf, "part.amf");
}

std::string instance(const std::string& target, const std::string& placing = "") {
    return "<instance objectid=\"" + target + "\">" + placing + "</instance>";
}

TEST_CASE("amf: objects stand where they are, in the unit of the document", "[formats]") {
    const MeshFile mm = read(amf(object("7")));
    CHECK(mm.mesh.triangles.size() == 4);
    CHECK(report_mesh(mm.mesh).volume_mm3 == Approx(1.0 / 6.0));
    CHECK(mm.triangle_colors.empty());
    const MeshFile inch = read(amf(object("7") + object("8"), " unit=\"inch\""));
    CHECK(inch.mesh.triangles.size() == 8);
    CHECK(inch.unit == LengthUnit::kInch);
    CHECK(report_mesh(inch.mesh).max_mm == Vec3(25.4, 25.4, 25.4));
}

TEST_CASE("amf: constellations turn about x, y, z and then move, one within another", "[formats]") {
    // A quarter turn about x takes y to z; one about z takes x to y.
    const std::string turned = instance("1", "<deltax>10</deltax><rx>90</rx><rz>90</rz>");
    const MeshFile once =
        read(amf(object("1") + object("2") + "<constellation id=\"3\">" + turned + "</constellation>"));
    REQUIRE(once.mesh.triangles.size() == 4);  // what no constellation names stays out
    const std::vector<Vec3> expected = {{10, 0, 0}, {10, 1, 0}, {10, 0, 1}, {11, 0, 0}};
    for (std::size_t v = 0; v < 4; ++v) CHECK((once.mesh.positions_mm[v] - expected[v]).norm() < 1e-12);
    CHECK(report_mesh(once.mesh).volume_mm3 == Approx(1.0 / 6.0));

    const std::string outer =
        "<constellation id=\"4\">" + instance("3") + instance("3", "<deltaz>5</deltaz>") + "</constellation>";
    const MeshFile twice = read(amf(object("1") + outer + "<constellation id=\"3\">" + turned + "</constellation>"));
    CHECK(twice.mesh.triangles.size() == 8);
    CHECK(report_mesh(twice.mesh).max_mm[2] == Approx(6.0));
}

TEST_CASE("amf: the nearest colour counts", "[formats]") {
    const std::string material = "<material id=\"m\">" + color(1, 0, 0) + "</material>";
    const Rgb8 red = {255, 0, 0}, green = {0, 255, 0}, blue = {0, 0, 255}, white = {255, 255, 255};
    const auto colors = [&](const std::string& body) { return read(amf(material + body)).triangle_colors; };
    CHECK(colors(object("1", " materialid=\"m\"")) == std::vector<Rgb8>(4, red));
    CHECK(colors(object("1", " materialid=\"m\"", color(0, 1, 0))) == std::vector<Rgb8>(4, green));
    CHECK(colors(object("1", " materialid=\"m\"", color(0, 1, 0), "", "", color(0, 0, 1))) ==
          std::vector<Rgb8>(4, blue));
    // Three of the four faces meet in the coloured corner.
    const std::vector<Rgb8> corner = colors(object("1", " materialid=\"m\"", "", color(0, 0, 1)));
    CHECK(corner == std::vector<Rgb8>{{170, 0, 85}, {170, 0, 85}, red, {170, 0, 85}});
    const std::vector<Rgb8> face = colors(object("1", " materialid=\"m\"", "", color(0, 0, 1), color(1, 1, 1)));
    CHECK(face == std::vector<Rgb8>{white, {170, 0, 85}, red, {170, 0, 85}});
}

TEST_CASE("amf: names of objects and volumes become parts", "[formats]") {
    const std::string named = object("1", "", "<metadata type=\"name\"> lid </metadata>");
    const MeshFile file = read(amf(named + object("2")));
    REQUIRE(file.parts.size() == 2);
    CHECK(file.parts[0].name == "lid");
    CHECK(file.parts[1].first_triangle == 4);
}

TEST_CASE("amf: a packed document reads as a plain one", "[formats]") {
    ZipWriter zip;
    zip.add("part.amf", amf(object("1")));
    const std::string packed = zip.finish();
    CHECK(read(packed).mesh.positions_mm == read(amf(object("1"))).mesh.positions_mm);
    ZipWriter two;
    two.add("part.amf", amf(object("1")));
    two.add("more.amf", amf(object("1")));
    CHECK_THROWS_AS(read(two.finish()), InvalidInput);
}

TEST_CASE("amf: what is left out is told", "[formats]") {
    const std::string formula = "<color><r>x*x</r><g>0</g><b>0</b></color>";
    const std::string normal = "<normal><nx>0</nx><ny>0</ny><nz>1</nz></normal>";
    const MeshFile file = read(amf(object("1", "", formula, normal) + "<texture id=\"9\"/>"));
    CHECK(file.triangle_colors.empty());
    CHECK(file.warnings.size() == 3);
}

TEST_CASE("amf: what cannot be read is named with its line", "[formats][errors]") {
    const auto refused = [](const std::string& bytes, const std::string& expected) {
        CAPTURE(bytes.substr(0, 200));
        CHECK_THROWS_AS(read(bytes), InvalidInput);
        CHECK_THROWS_WITH(read(bytes), Catch::Contains("part.amf") && Catch::Contains(expected));
    };
    refused("", "line");
    refused("<stl/>", "<amf>");
    refused(amf(""), "no triangle");
    refused(amf("", " unit=\"furlong\""), "furlong");
    refused(amf(object("1") + object("1")), "a second object");
    refused(amf("<object/>"), "without an id");
    refused(amf("<object id=\"1\"><mesh><vertices>" + vertex("0", "nan", "0") + "</vertices></mesh></object>"), "nan");
    refused(amf("<object id=\"1\"><mesh><vertices>" + vertex("0", "2e9", "0") + "</vertices></mesh></object>"), "1e9");
    refused(amf("<object id=\"1\"><mesh><vertices>" + vertex("0", "0", "0") + "</vertices><volume>" +
                triangle(0, 0, 4) + "</volume></mesh></object>"),
            "vertex 4");
    refused(amf("<object id=\"1\"><mesh><volume><triangle><v1>0</v1></triangle></volume></mesh></object>"), "v2");
    refused(amf("<object id=\"1\"><mesh><volume><triangle><v1>4294967296</v1></triangle></volume></mesh></object>"),
            "4294967296");
    refused(amf(object("1") + "<constellation id=\"2\">" + instance("9") + "</constellation>"), "\"9\"");
    refused(amf(object("1") + "<constellation id=\"2\">" + instance("2") + "</constellation>"), "each other");
    refused(amf("<!-- open"), "well-formed");
}

TEST_CASE("amf: constellations that double at every level are refused at once", "[formats][errors]") {
    std::string body = object("0");
    for (int level = 1; level <= 40; ++level) {
        const std::string below = std::to_string(level - 1);
        body += "<constellation id=\"" + std::to_string(level) + "\">" + instance(below) + instance(below) +
                "</constellation>";
    }
    CHECK_THROWS_AS(read(amf(body)), InvalidInput);
    std::string wide = object("0");
    for (int level = 1; level <= 6; ++level) {
        wide += "<constellation id=\"" + std::to_string(level) + "\">";
        for (int i = 0; i < 60; ++i) wide += instance(std::to_string(level - 1));
        wide += "</constellation>";
    }
    CHECK_THROWS_AS(read(amf(wide)), InvalidInput);
    // Trees that hold no triangle, or nothing at all, are endless too.
    for (const std::string leaf : {"<object id=\"0\"/>", "<constellation id=\"0\"/>"}) {
        std::string bare = object("solid") + leaf + wide.substr(object("0").size());
        CAPTURE(leaf);
        CHECK_THROWS_WITH(read(amf(bare)), Catch::Contains("16384"));
    }
}

}  // namespace
}  // namespace fretwork
