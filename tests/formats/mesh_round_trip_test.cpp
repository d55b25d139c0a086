// What is written is read back: exactly where the format holds floats, to the printed digits elsewhere.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/float_rounding.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::as_soup;
using testing::make_box;
using testing::make_icosphere;
using testing::make_square;

constexpr std::array<MeshFormat, 6> kAll = {MeshFormat::kStl, MeshFormat::kObj,     MeshFormat::kPly,
                                            MeshFormat::kOff, MeshFormat::kThreemf, MeshFormat::kAmf};

double random_unit(std::uint64_t seed, std::uint64_t item, std::uint32_t draw) {
    return unit_interval(counter_random(seed, RandomStream::kTest, 1, item, draw));
}

/// Vertices of all sizes from 1e-6 to 1e6, no two alike, and triangles that use each of them.
TriangleMesh random_mesh(std::uint64_t seed) {
    TriangleMesh mesh;
    const auto vertices = static_cast<std::uint32_t>(3 + 97 * random_unit(seed, 0, 0));
    for (std::uint32_t v = 0; v < vertices; ++v) {
        const double size = std::pow(10.0, 12.0 * random_unit(seed, v, 3) - 6.0);
        mesh.positions_mm.emplace_back(size * (random_unit(seed, v, 0) - 0.5), size * (random_unit(seed, v, 1) - 0.5),
                                       static_cast<double>(v) + random_unit(seed, v, 2));
    }
    for (std::uint32_t t = 0; t < vertices; ++t) mesh.triangles.push_back({t, (t + 1) % vertices, (t + 2) % vertices});
    return mesh;
}

TriangleMesh rounded_to_floats(TriangleMesh mesh) {
    for (Vec3& p : mesh.positions_mm) p = rounded_to_float(p);
    return mesh;
}

std::vector<Rgb8> random_colors(std::uint64_t seed, std::size_t count) {
    std::vector<Rgb8> colors(count);
    for (std::size_t i = 0; i < count; ++i)
        for (std::size_t k = 0; k < 3; ++k)
            colors[i][k] = static_cast<std::uint8_t>(
                counter_random(seed, RandomStream::kTest, 2, i, static_cast<std::uint32_t>(k)) & 0xFF);
    return colors;
}

/// The corners of all triangles in order: the same for two meshes that differ in vertex numbers only.
std::vector<Vec3> corners_of(const TriangleMesh& mesh) {
    std::vector<Vec3> corners;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) corners.push_back(mesh.positions_mm[v]);
    return corners;
}

// Text holds the shortest digits that name a float, so a reader in double precision sees a number
// next to it that rounds to the same float.
TEST_CASE("mesh files: every format gives back the floats it was given", "[formats][property]") {
    const auto seed = GENERATE(range<std::uint64_t>(1, 7));
    const MeshFormat format = GENERATE(from_range(kAll));
    CAPTURE(seed, static_cast<int>(format));
    const TriangleMesh mesh = random_mesh(seed);
    const MeshFile file = read_mesh(write_mesh({mesh}, format), format, "memory");

    CHECK(corners_of(rounded_to_floats(file.mesh)) == corners_of(rounded_to_floats(mesh)));
    if (format == MeshFormat::kStl || format == MeshFormat::kPly)
        CHECK(corners_of(file.mesh) == corners_of(rounded_to_floats(mesh)));
    CHECK(file.triangle_colors.empty());
    CHECK(file.warnings.empty());
    // STL numbers vertices by first use, which here is their order anyway.
    CHECK(file.mesh.triangles == mesh.triangles);
}

TEST_CASE("mesh files: formats with double precision keep every bit", "[formats][property]") {
    const auto seed = GENERATE(range<std::uint64_t>(1, 7));
    const MeshFormat format = GENERATE(MeshFormat::kObj, MeshFormat::kPly, MeshFormat::kOff, MeshFormat::kAmf);
    const TriangleMesh mesh = random_mesh(seed);
    const MeshToWrite input{mesh, {}, "part", CoordinatePrecision::kDouble};
    const MeshFile file = read_mesh(write_mesh(input, format), format, "memory");
    CHECK(file.mesh.positions_mm == mesh.positions_mm);
    CHECK(file.mesh.triangles == mesh.triangles);
}

TEST_CASE("mesh files: colours of triangles survive where the format has them", "[formats][property]") {
    const auto seed = GENERATE(range<std::uint64_t>(1, 4));
    const MeshFormat format = GENERATE(MeshFormat::kPly, MeshFormat::kOff, MeshFormat::kThreemf, MeshFormat::kAmf);
    const TriangleMesh mesh = random_mesh(seed);
    const std::vector<Rgb8> colors = random_colors(seed, mesh.triangles.size());
    const MeshFile file = read_mesh(write_mesh({mesh, colors}, format), format, "memory");
    CHECK(file.triangle_colors == colors);
    // Neighbours that are alike but for one channel, in runs of two.
    std::vector<Rgb8> close = colors;
    for (std::size_t t = 0; t < close.size(); ++t) close[t] = {7, 7, static_cast<std::uint8_t>(t / 2)};
    CHECK(read_mesh(write_mesh({mesh, close}, format), format, "memory").triangle_colors == close);
}

TEST_CASE("mesh files: STL corners at one place become one vertex, minus zero included", "[formats]") {
    const TriangleMesh box = make_box(Vec3(0, 0, 0), Vec3(3, 2, 1), {2, 3, 4});
    const TriangleMesh soup = rounded_to_floats(as_soup(box));
    REQUIRE(soup.positions_mm.size() == 3 * box.triangles.size());
    TriangleMesh negative = soup;
    for (std::size_t v = 0; v < negative.positions_mm.size(); v += 2)
        for (int k = 0; k < 3; ++k)
            if (negative.positions_mm[v][k] == 0.0) negative.positions_mm[v][k] = -0.0;
    const MeshFile file = read_mesh(write_mesh({negative}, MeshFormat::kStl), MeshFormat::kStl, "memory");
    CHECK(file.mesh.positions_mm.size() == box.positions_mm.size());
    CHECK(corners_of(file.mesh) == corners_of(soup));
}

TEST_CASE("mesh files: STL normals have unit length and face outward", "[formats]") {
    const TriangleMesh sphere = make_icosphere(10.0, 2);
    const std::string bytes = write_mesh({sphere}, MeshFormat::kStl);
    REQUIRE(bytes.size() == 84 + 50 * sphere.triangles.size());
    CHECK(bytes.substr(0, 5) != "solid");
    for (std::size_t t = 0; t < sphere.triangles.size(); ++t) {
        std::array<float, 6> numbers{};
        std::copy_n(bytes.data() + 84 + 50 * t, 24, reinterpret_cast<char*>(numbers.data()));
        const Vec3 normal(numbers[0], numbers[1], numbers[2]), corner(numbers[3], numbers[4], numbers[5]);
        // Three floats of a unit vector, each rounded to 24 bits.
        CHECK(normal.norm() == Approx(1.0).margin(1e-6));
        CHECK(normal.dot(corner) > 0.9 * corner.norm());
    }
}

TEST_CASE("mesh files: a triangle without area gets a unit normal all the same", "[formats]") {
    const TriangleMesh flat{{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0)}, {{0, 1, 2}}};
    const std::string bytes = write_mesh({flat}, MeshFormat::kStl);
    // admesh takes a file without a byte over 127 behind its header for text.
    CHECK(std::any_of(bytes.begin() + 84, bytes.end(), [](char c) { return static_cast<unsigned char>(c) > 127; }));
}

TEST_CASE("mesh files: the same mesh gives the same bytes", "[formats][determinism]") {
    const MeshFormat format = GENERATE(from_range(kAll));
    const TriangleMesh mesh = random_mesh(3);
    const std::vector<Rgb8> colors = random_colors(3, mesh.triangles.size());
    CHECK(write_mesh({mesh, colors}, format) == write_mesh({mesh, colors}, format));
}

TEST_CASE("mesh files: what cannot be written is named", "[formats][errors]") {
    TriangleMesh mesh = make_square(1.0);
    const std::vector<Rgb8> colors(mesh.triangles.size() + 1);
    const MeshFormat format = GENERATE(from_range(kAll));
    CHECK_THROWS_AS(write_mesh({mesh, colors}, format), InvalidInput);
    TriangleMesh dangling = mesh;
    dangling.triangles[1][2] = 99;
    CHECK_THROWS_WITH(write_mesh({dangling}, format), Catch::Contains("triangle 1") && Catch::Contains("99"));
    mesh.positions_mm[2][1] = std::nan("");
    CHECK_THROWS_WITH(write_mesh({mesh}, format), Catch::Contains("vertex 2"));
}

TEST_CASE("mesh files: the format comes from the extension, whatever its case", "[formats]") {
    CHECK(mesh_format_from_path("a/b.STL") == MeshFormat::kStl);
    CHECK(mesh_format_from_path("b.3mf") == MeshFormat::kThreemf);
    CHECK(mesh_format_from_name(".Ply") == MeshFormat::kPly);
    CHECK_THROWS_WITH(mesh_format_from_path("model.xyz"), Catch::Contains("model.xyz") && Catch::Contains("stl"));
    CHECK_THROWS_AS(mesh_format_from_path("model"), InvalidSetting);
}

}  // namespace
}  // namespace fretwork
