// Mesh files as people and programs write them, and as they should not.
#include <array>
#include <catch2/catch.hpp>
#include <string>

#include "core/base/error.h"
#include "formats/byte_order.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::area_mm2;
using testing::make_box;
using testing::make_square;

MeshFile read(MeshFormat format, std::string_view bytes) {
    return read_mesh(bytes, format, "model");
}

const std::string kAsciiStl =
    "solid first part\n"
    " facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1e0 0\n  endloop\n endfacet\n"
    "endsolid first part\n"
    "SOLID\n"
    " FACET NORMAL nan nan -nan(ind)\n  OUTER LOOP\n   VERTEX 1 0 0\n   VERTEX +1.0 1 0\n   VERTEX 0 1 0\n  ENDLOOP\n"
    " ENDFACET\nENDSOLID\n";

TEST_CASE("stl: ASCII with several solids, capitals and nonsense normals", "[formats]") {
    const MeshFile file = read(MeshFormat::kStl, kAsciiStl);
    REQUIRE(file.mesh.triangles.size() == 2);
    CHECK(file.mesh.positions_mm.size() == 4);
    CHECK(file.mesh.triangles[1] == Triangle{1, 3, 2});
    REQUIRE(file.parts.size() == 2);
    CHECK(file.parts[0].name == "first part");
    CHECK(file.parts[1].first_triangle == 1);
}

TEST_CASE("stl: line ends of all systems read alike", "[formats]") {
    for (const std::string line_end : {"\r\n", "\r"}) {
        std::string text;
        for (const char c : kAsciiStl) text += c == '\n' ? line_end : std::string(1, c);
        CHECK(read(MeshFormat::kStl, text).mesh.positions_mm == read(MeshFormat::kStl, kAsciiStl).mesh.positions_mm);
    }
}

/// Zero normals and small whole coordinates: no byte behind the header is over 127, and the header says "solid".
std::string binary_stl_that_looks_like_text(std::uint32_t triangles) {
    std::string bytes = "solid but binary";
    bytes.resize(80, ' ');
    append_little(bytes, triangles);
    for (std::uint32_t t = 0; t < triangles; ++t) {
        for (const float value : {0.f, 0.f, 0.f, 0.f, 0.f, 2.f, 2.f, 0.f, 2.f, 0.f, 2.f, 2.f})
            append_little(bytes, value);
        append_little(bytes, std::uint16_t{0});
    }
    return bytes;
}

TEST_CASE("stl: the size decides that a file is binary, not its first word", "[formats]") {
    const MeshFile file = read(MeshFormat::kStl, binary_stl_that_looks_like_text(3));
    CHECK(file.mesh.triangles.size() == 3);
    CHECK(file.mesh.positions_mm.size() == 3);
}

TEST_CASE("stl: bytes behind the last binary triangle are skipped and reported", "[formats]") {
    std::string bytes = binary_stl_that_looks_like_text(2);
    bytes.replace(0, 5, "other");
    const MeshFile file = read(MeshFormat::kStl, bytes + "trailer");
    CHECK(file.mesh.triangles.size() == 2);
    REQUIRE(file.warnings.size() == 1);
    CHECK_THAT(file.warnings[0], Catch::Contains("7 bytes"));
}

TEST_CASE("obj: negative indices, slashes, polygons, continued lines, names and colours", "[formats]") {
    const MeshFile file =
        read(MeshFormat::kObj,
             "# comment\r\nmtllib none.mtl\no left wing\nv 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 1 1 0 1 0 0\n"
             "v 0 1 0 1 0 0\nvt 0 0\nvn 0 0 1\nf 1/1/1 2//1 3/1 \\\n 4\no right\n"
             "v 0 0 1 0 0 1 # blue\nf -1 -5 -4\n");
    REQUIRE(file.mesh.triangles.size() == 3);
    CHECK(file.mesh.triangles[0] == Triangle{0, 1, 2});
    CHECK(file.mesh.triangles[1] == Triangle{0, 2, 3});
    CHECK(file.mesh.triangles[2] == Triangle{4, 0, 1});
    REQUIRE(file.parts.size() == 2);
    CHECK(file.parts[0].name == "left wing");
    CHECK(file.parts[1].first_triangle == 2);
    REQUIRE(file.triangle_colors.size() == 3);
    CHECK(file.triangle_colors[0] == Rgb8{255, 0, 0});
    CHECK(file.triangle_colors[2] == Rgb8{170, 0, 85});
    CHECK(file.warnings.size() == 1);
}

TEST_CASE("obj: a polygon that is not convex keeps its area", "[formats]") {
    // An arrow head; a fan from its first corner would cover the notch.
    const MeshFile file = read(MeshFormat::kObj, "v 0 0 0\nv 2 3 0\nv 0 1 0\nv -2 3 0\nf 1 2 3 4\n");
    REQUIRE(file.mesh.triangles.size() == 2);
    CHECK(area_mm2(file.mesh) == Approx(2.0));  // 2 * (1 * 2 / 2): each half has its base from (0,0) to (0,1).
    for (const Triangle& t : file.mesh.triangles) {
        const Vec3& a = file.mesh.positions_mm[t[0]];
        const Vec3 ab = file.mesh.positions_mm[t[1]] - a, ac = file.mesh.positions_mm[t[2]] - a;
        CHECK(ab[0] * ac[1] - ab[1] * ac[0] > 0.0);
    }
}

TEST_CASE("obj: faces may name vertices that come later", "[formats]") {
    const MeshFile file = read(MeshFormat::kObj, "f 1 2 3 4\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n");
    CHECK(area_mm2(file.mesh) == Approx(1.0));
}

TEST_CASE("off: header variants, comments, colours and polygons", "[formats]") {
    const MeshFile plain = read(MeshFormat::kOff,
                                "OFF # a square and a triangle\n5 2 0\n0 0 0\n1 0 0\n\n1 1 0\n0 1 0\n0 0 1\n"
                                "4 0 1 2 3 255 0 0\n3 0 1 4 0.0 0.5 1.0 1.0 # half\n");
    REQUIRE(plain.mesh.triangles.size() == 3);
    REQUIRE(plain.triangle_colors.size() == 3);
    CHECK(plain.triangle_colors[1] == Rgb8{255, 0, 0});
    CHECK(plain.triangle_colors[2] == Rgb8{0, 128, 255});

    const MeshFile colored =
        read(MeshFormat::kOff, "COFF 3 1 3\n0 0 0 255 0 0 255\n1 0 0 0 255 0 255\n0 1 0 0 0 255 255\n3 0 1 2\n");
    REQUIRE(colored.triangle_colors.size() == 1);
    CHECK(colored.triangle_colors[0] == Rgb8{85, 85, 85});

    const MeshFile bare = read(MeshFormat::kOff, "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 7\n");
    CHECK(bare.triangle_colors.empty());
    CHECK(bare.warnings.size() == 1);

    const MeshFile normals = read(MeshFormat::kOff, "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n");
    CHECK(normals.mesh.positions_mm[1] == Vec3(1, 0, 0));
}

TEST_CASE("ply: ASCII with extra elements, properties in another order, quads and face colours", "[formats]") {
    const MeshFile file = read(
        MeshFormat::kPly,
        "ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\nelement junk 2\nproperty list uchar int stuff\n"
        "element face 2\nproperty uchar red\nproperty list uchar uint vertex_index\nproperty uchar green\n"
        "property uchar blue\nelement vertex 4\nproperty float nx\nproperty double z\nproperty float y\n"
        "property float x\nend_header\n2 7 8\n0\n10 4 0 1 2 3 20 30\n1 3 0 1 2 2 3\n"
        "0 0 0 0\n0 0 0 1\n0 0 1 1\n0 0.5 1 0\n");
    REQUIRE(file.mesh.triangles.size() == 3);
    CHECK(file.mesh.positions_mm[3] == Vec3(0, 1, 0.5));
    CHECK(file.triangle_colors[1] == Rgb8{10, 20, 30});
    CHECK(file.triangle_colors[2] == Rgb8{1, 2, 3});
}

TEST_CASE("ply: both byte orders and triangle strips", "[formats]") {
    for (const std::endian order : {std::endian::little, std::endian::big}) {
        const std::string name = order == std::endian::little ? "little" : "big";
        std::string bytes = "ply\nformat binary_" + name +
                            "_endian 1.0\nelement vertex 4\nproperty float x\nproperty short y\nproperty double z\n"
                            "property ushort red\nproperty ushort green\nproperty ushort blue\n"
                            "element tristrips 1\nproperty list int int vertex_indices\nend_header\n";
        const auto append = [&](auto value) {
            std::string piece;
            append_little(piece, value);
            if (order == std::endian::big) std::reverse(piece.begin(), piece.end());
            bytes += piece;
        };
        for (int v = 0; v < 4; ++v) {
            append(static_cast<float>(v % 2) * 1.5f);
            append(static_cast<std::int16_t>(v / 2 - 300));
            append(-0.25);
            for (const int channel : {65535, 0, 32768}) append(static_cast<std::uint16_t>(channel));
        }
        append(std::int32_t{6});
        for (const std::int32_t v : {0, 1, 2, 3, -1, 0}) append(v);
        const MeshFile file = read(MeshFormat::kPly, bytes);
        CAPTURE(name);
        REQUIRE(file.mesh.triangles.size() == 2);
        CHECK(file.mesh.triangles[0] == Triangle{0, 1, 2});
        CHECK(file.mesh.triangles[1] == Triangle{2, 1, 3});
        CHECK(file.mesh.positions_mm[3] == Vec3(1.5, -299, -0.25));
        CHECK(file.triangle_colors[0] == Rgb8{255, 0, 128});
    }
}

TEST_CASE("mesh files: the unit of a file without units is the caller's to say", "[formats]") {
    const MeshFile file =
        read_mesh("v 1 0 0\nv 0 2 0\nv 0 0 3\nf 1 2 3\n", MeshFormat::kObj, "m", {.unit = LengthUnit::kInch});
    CHECK(file.mesh.positions_mm[1] == Vec3(0, 2 * 25.4, 0));
    CHECK(file.unit == LengthUnit::kInch);
}

struct BadFile {
    MeshFormat format;
    std::string bytes;
    std::string place;  ///< what the message must name
    std::string expected;
};

TEST_CASE("mesh files: broken ones are refused with place, found and expected", "[formats][errors]") {
    const std::string ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const std::vector<BadFile> files = {
        {MeshFormat::kStl, "", "byte 0", "an STL"},
        {MeshFormat::kStl, "solid x\nendsolid x\n", "no triangle", "at least one"},
        {MeshFormat::kStl, "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 nan\n", "line 4", "a coordinate"},
        {MeshFormat::kStl, "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1e10\n", "line 4", "at most 1e9"},
        {MeshFormat::kStl, "solid x\nfacet normal 0 0 1\nouter hoop\n", "line 3: found \"hoop\"", "\"loop\""},
        {MeshFormat::kStl, std::string(84, '\0'), "byte 84", "at least one"},
        {MeshFormat::kObj, "", "no triangle", "at least one"},
        {MeshFormat::kObj, "v 0 0\n", "line 1: found the end of the", "a coordinate"},
        {MeshFormat::kObj, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "line 4: found vertex index 4", "at most 3"},
        {MeshFormat::kObj, "v 0 0 0\nf 1 0 1\n", "line 2: found \"0\"", "a vertex index"},
        {MeshFormat::kObj, "v 0 0 0\nf 1 -2 1\n", "line 2: found \"-2\"", "a vertex index"},
        {MeshFormat::kObj, "v 0 0 0\nf 1 4294967297 1\n", "line 2: found \"4294967297\"", "a vertex index"},
        {MeshFormat::kObj, "v 0 0 0\nf 1 1\n", "line 2", "three corners"},
        {MeshFormat::kOff, "4OFF 1 1 0\n", "line 1: found \"4OFF\"", "OFF"},
        {MeshFormat::kOff, "OFF BINARY\n", "line 1: found \"BINARY\"", "text"},
        {MeshFormat::kOff, "OFF 99999999 1 0\n0 0 0\n", "line 1: found \"99999999\"", "at most"},
        {MeshFormat::kOff, "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 5: found \"3\"", "below 3"},
        {MeshFormat::kOff, "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -1\n", "line 5: found \"-1\"", "below 3"},
        {MeshFormat::kOff, "OFF 3 1 0\n0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", "line 3: found \"inf\"", "a coordinate"},
        {MeshFormat::kPly, "plx\n", "line 1: found \"plx\"", "\"ply\""},
        {MeshFormat::kPly, "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n",
         "the end", "4000000000 rows"},
        {MeshFormat::kPly, ply + "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", "line 13: found \"3\"", "below 3"},
        {MeshFormat::kPly, ply + "0 0 0\n1 0 0\n0 1 0\n200 0 1 2\n", "line 13: found \"200\"", "the file can hold"},
        {MeshFormat::kPly, ply + "0 0 0\n1 0 1e20\n0 1 0\n3 0 1 2\n", "line 11: found \"1e20\"", "1e9"},
        {MeshFormat::kThreemf, "not a zip", "archive", "a ZIP archive"},
    };
    for (const BadFile& bad : files) {
        CAPTURE(bad.bytes);
        CHECK_THROWS_AS(read(bad.format, bad.bytes), InvalidInput);
        CHECK_THROWS_WITH(read(bad.format, bad.bytes),
                          Catch::StartsWith("model: ") && Catch::Contains(bad.place) && Catch::Contains(bad.expected));
    }
}

TEST_CASE("mesh files: cut off anywhere, a file is refused or read in part, and nothing else", "[formats][errors]") {
    const TriangleMesh mesh = make_box(Vec3(0, 0, 0), Vec3(1, 2, 3));
    const std::vector<Rgb8> colors(mesh.triangles.size(), Rgb8{1, 2, 3});
    for (const MeshFormat format : {MeshFormat::kStl, MeshFormat::kPly, MeshFormat::kOff, MeshFormat::kObj,
                                    MeshFormat::kThreemf, MeshFormat::kAmf}) {
        const std::string whole = write_mesh({mesh, colors}, format);
        CAPTURE(static_cast<int>(format));
        for (std::size_t size = 0; size < whole.size(); ++size) {
            CAPTURE(size);
            const std::string_view cut = std::string_view(whole).substr(0, size);
            // Text does not show that its last number or line is cut; the formats that name their counts do
            // up to there.
            const bool may_read = format == MeshFormat::kObj ||
                                  (format == MeshFormat::kOff && size > whole.rfind('\n', whole.size() - 2)) ||
                                  (format == MeshFormat::kAmf && size > whole.rfind('>'));
            try {
                const MeshFile file = read(format, cut);
                REQUIRE(may_read);
                REQUIRE(file.mesh.triangles.size() <= mesh.triangles.size());
            } catch (const InvalidInput& refused) {
                REQUIRE_THAT(refused.what(),
                             Catch::StartsWith("model: ") && Catch::Contains("found") && Catch::Contains("expected"));
            }
        }
    }
    // ASCII STL says where it ends.
    for (std::size_t size = 0; size + 9 < kAsciiStl.size(); ++size) {
        const bool first_solid_whole = size > kAsciiStl.find("endsolid") + 7 && size <= kAsciiStl.find("SOLID");
        CAPTURE(size);
        if (!first_solid_whole) CHECK_THROWS_AS(read(MeshFormat::kStl, kAsciiStl.substr(0, size)), InvalidInput);
    }
}

TEST_CASE("mesh files: reading stops when asked", "[formats][cancel]") {
    std::stop_source source;
    source.request_stop();
    const RunControl run({}, source.get_token());
    const TriangleMesh mesh = make_square(1.0);
    for (const MeshFormat format : {MeshFormat::kStl, MeshFormat::kPly, MeshFormat::kOff, MeshFormat::kObj,
                                    MeshFormat::kThreemf, MeshFormat::kAmf}) {
        const std::string bytes = write_mesh({mesh}, format);
        CHECK_THROWS_AS(read_mesh(bytes, format, "m", {.unit = LengthUnit::kMillimeter}, run), Cancelled);
    }
}

}  // namespace
}  // namespace fretwork
