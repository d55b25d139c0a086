// GLB out: read back by its own rules, not by our writer's.
#include <Eigen/Geometry>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/error.h"
#include "formats/byte_order.h"
#include "formats/glb_writer.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using Json = nlohmann::json;

struct Glb {
    Json description;
    std::string data;
};

template <class T>
T at(const std::string& bytes, std::size_t offset) {
    REQUIRE(offset + sizeof(T) <= bytes.size());
    return load<T>(bytes.data() + offset, std::endian::little);
}

Glb parse(const std::string& bytes) {
    REQUIRE(bytes.size() >= 20);
    CHECK(bytes.substr(0, 4) == "glTF");
    CHECK(at<std::uint32_t>(bytes, 4) == 2);
    CHECK(at<std::uint32_t>(bytes, 8) == bytes.size());
    const auto json_size = at<std::uint32_t>(bytes, 12);
    CHECK(json_size % 4 == 0);
    CHECK(bytes.substr(16, 4) == "JSON");
    Glb glb{Json::parse(bytes.substr(20, json_size)), {}};
    const auto data_size = at<std::uint32_t>(bytes, 20 + json_size);
    CHECK(data_size % 4 == 0);
    CHECK(bytes.substr(24 + json_size, 4) == std::string("BIN\0", 4));
    glb.data = bytes.substr(28 + json_size);
    CHECK(glb.data.size() == data_size);
    return glb;
}

/// Offset of an accessor's first element; checks that all of it lies within the data.
std::size_t offset_of(const Glb& glb, const Json& accessor, std::size_t element_bytes) {
    const Json& view = glb.description["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    CHECK(view["byteLength"].get<std::size_t>() == accessor["count"].get<std::size_t>() * element_bytes);
    CHECK(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>() <= glb.data.size());
    return view["byteOffset"];
}

/// Positions as a viewer places them: the node's scale, then its turn, then metres to millimetres.
Vec3 placed_mm(const Json& node, const Vec3& p) {
    const auto q = node["rotation"].get<std::array<double, 4>>();
    const auto s = node["scale"].get<std::array<double, 3>>();
    const Eigen::Quaterniond turn(q[3], q[0], q[1], q[2]);
    return 1000.0 * (turn * Vec3(s[0] * p[0], s[1] * p[1], s[2] * p[2]));
}

TEST_CASE("glb: triangles, places and colours are those of the mesh", "[formats]") {
    const TriangleMesh box = testing::make_box(Vec3(0, 0, 0), Vec3(3, 2, 1));
    std::vector<Rgb8> colors(box.triangles.size());
    for (std::size_t t = 0; t < colors.size(); ++t) colors[t] = t % 2 == 0 ? Rgb8{255, 0, 0} : Rgb8{0, 128, 64};
    const bool colored = GENERATE(false, true);
    const Glb glb =
        parse(write_glb({box, colored ? std::span<const Rgb8>(colors) : std::span<const Rgb8>(), "a \"box\""}));
    const Json& primitive = glb.description["meshes"][0]["primitives"][0];
    const Json& accessors = glb.description["accessors"];
    const Json& positions = accessors[primitive["attributes"]["POSITION"].get<std::size_t>()];
    const Json& indices = accessors[primitive["indices"].get<std::size_t>()];
    const std::size_t position_at = offset_of(glb, positions, 12), index_at = offset_of(glb, indices, 4);
    REQUIRE(indices["count"] == 3 * box.triangles.size());
    CHECK(positions["min"] == Json({0.0, 0.0, 0.0}));
    CHECK(positions["max"] == Json({3.0, 2.0, 1.0}));
    CHECK(primitive["attributes"].contains("COLOR_0") == colored);

    const Json& node = glb.description["nodes"][0];
    CHECK(node["name"] == "a \"box\"");
    for (std::size_t corner = 0; corner < 3 * box.triangles.size(); ++corner) {
        const auto vertex = at<std::uint32_t>(glb.data, index_at + 4 * corner);
        REQUIRE(vertex < positions["count"].get<std::size_t>());
        Vec3 p;
        for (std::size_t k = 0; k < 3; ++k)
            p[static_cast<int>(k)] = at<float>(glb.data, position_at + 12 * vertex + 4 * k);
        const Vec3& expected = box.positions_mm[box.triangles[corner / 3][corner % 3]];
        // z up becomes y up: (x, y, z) stands at (x, z, -y).
        CHECK((placed_mm(node, p) - Vec3(expected[0], expected[2], -expected[1])).norm() < 1e-9);
        if (!colored) continue;
        const Json& channel = accessors[primitive["attributes"]["COLOR_0"].get<std::size_t>()];
        CHECK(channel["normalized"] == true);
        const std::size_t color_at = offset_of(glb, channel, 8) + 8 * vertex;
        const Rgb8& color = colors[corner / 3];
        for (std::size_t k = 0; k < 3; ++k) {
            const double c = color[k] / 255.0;
            const double linear = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
            CHECK(at<std::uint16_t>(glb.data, color_at + 2 * k) == Approx(65535.0 * linear).margin(1.0));
        }
        CHECK(at<std::uint16_t>(glb.data, color_at + 6) == 65535);
    }
}

TEST_CASE("glb: vertices are shared unless colours part them", "[formats]") {
    const TriangleMesh ball = testing::make_icosphere(5.0, 2);
    const std::vector<Rgb8> one(ball.triangles.size(), Rgb8{9, 9, 9});
    const auto count = [](const std::string& bytes) {
        return parse(bytes).description["accessors"][0]["count"].get<std::size_t>();
    };
    CHECK(count(write_glb({ball})) == ball.positions_mm.size());
    CHECK(count(write_glb({ball, one})) == ball.positions_mm.size());
    std::vector<Rgb8> two = one;
    two[0] = {10, 9, 9};
    CHECK(count(write_glb({ball, two})) == ball.positions_mm.size() + 3);
}

TEST_CASE("glb: is only written", "[formats][errors]") {
    const std::string bytes = write_mesh({testing::make_square(1.0)}, MeshFormat::kGlb);
    CHECK_THROWS_AS(read_mesh(bytes, MeshFormat::kGlb, "m"), InvalidSetting);
}

}  // namespace
}  // namespace fretwork
