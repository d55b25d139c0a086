#include "formats/glb_writer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "core/base/error.h"
#include "core/exemplar/color_space.h"
#include "formats/byte_order.h"

namespace fretwork {
namespace {

constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

/// Vertices as glTF has them: one colour each.
struct Vertices {
    std::vector<std::uint32_t> source;  ///< vertex of the mesh
    std::vector<Rgb8> colors;           ///< empty without colours
    std::vector<std::uint32_t> indices;
};

std::uint32_t key_of(const Rgb8& c) {
    return static_cast<std::uint32_t>(c[0]) << 16 | static_cast<std::uint32_t>(c[1]) << 8 | c[2];
}

/// Numbered in order of first use.
Vertices split_by_color(const MeshToWrite& input) {
    Vertices out;
    out.indices.reserve(3 * input.mesh.triangles.size());
    if (input.triangle_colors.empty()) {
        for (std::uint32_t v = 0; v < input.mesh.positions_mm.size(); ++v) out.source.push_back(v);
        for (const Triangle& t : input.mesh.triangles) out.indices.insert(out.indices.end(), t.begin(), t.end());
        return out;
    }
    std::vector<std::vector<std::uint32_t>> copies(input.mesh.positions_mm.size());
    for (std::size_t t = 0; t < input.mesh.triangles.size(); ++t) {
        const Rgb8& color = input.triangle_colors[t];
        for (const std::uint32_t v : input.mesh.triangles[t]) {
            const auto known = std::ranges::find_if(
                copies[v], [&](std::uint32_t copy) { return key_of(out.colors[copy]) == key_of(color); });
            if (known != copies[v].end()) {
                out.indices.push_back(*known);
                continue;
            }
            const auto fresh = static_cast<std::uint32_t>(out.source.size());
            copies[v].push_back(fresh);
            out.source.push_back(v);
            out.colors.push_back(color);
            out.indices.push_back(fresh);
        }
    }
    return out;
}

struct Box {
    std::array<float, 3> low{}, high{};
};

Box box_of(const MeshToWrite& input, const Vertices& vertices) {
    Box box;
    box.low.fill(std::numeric_limits<float>::max());
    box.high.fill(std::numeric_limits<float>::lowest());
    for (const std::uint32_t v : vertices.source)
        for (int k = 0; k < 3; ++k) {
            const auto x = static_cast<float>(input.mesh.positions_mm[v][k]);
            auto& low = box.low[static_cast<std::size_t>(k)];
            auto& high = box.high[static_cast<std::size_t>(k)];
            low = std::min(low, x);
            high = std::max(high, x);
        }
    return box;
}

std::string buffer_of(const MeshToWrite& input, const Vertices& vertices) {
    std::string bytes;
    bytes.reserve(12 * vertices.source.size() + 4 * vertices.colors.size() + 4 * vertices.indices.size());
    for (const std::uint32_t v : vertices.source)
        for (int k = 0; k < 3; ++k) append_little(bytes, static_cast<float>(input.mesh.positions_mm[v][k]));
    for (const Rgb8& color : vertices.colors) {
        // 16 bits, because 8 linear ones would band dark colours.
        for (const std::uint8_t c : color)
            append_little(bytes, static_cast<std::uint16_t>(
                                     std::lround(65535.0F * srgb_to_linear(static_cast<float>(c) / 255.0F))));
        append_little(bytes, std::uint16_t{65535});
    }
    for (const std::uint32_t index : vertices.indices) append_little(bytes, index);
    return bytes;
}

nlohmann::ordered_json description_of(const MeshToWrite& input, const Vertices& vertices) {
    const Box box = box_of(input, vertices);
    const std::size_t positions = 12 * vertices.source.size();
    const std::size_t colors = 8 * vertices.colors.size();
    const std::size_t indices = 4 * vertices.indices.size();
    nlohmann::ordered_json gltf;
    gltf["asset"] = {{"version", "2.0"}, {"generator", "Fretwork"}};
    gltf["scene"] = 0;
    gltf["scenes"] = {{{"nodes", {0}}}};
    const double half = std::numbers::sqrt2 / 2.0;
    gltf["nodes"] = {
        {{"name", input.name}, {"mesh", 0}, {"rotation", {-half, 0.0, 0.0, half}}, {"scale", {0.001, 0.001, 0.001}}}};
    nlohmann::ordered_json primitive = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"material", 0}};
    gltf["materials"] = {{{"pbrMetallicRoughness", {{"metallicFactor", 0.0}, {"roughnessFactor", 0.6}}}}};
    constexpr int kFloat = 5126, kUnsigned16 = 5123, kUnsigned32 = 5125, kVertexBuffer = 34962, kIndexBuffer = 34963;
    gltf["bufferViews"] = {
        {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", positions}, {"target", kVertexBuffer}},
        {{"buffer", 0}, {"byteOffset", positions + colors}, {"byteLength", indices}, {"target", kIndexBuffer}}};
    gltf["accessors"] = {
        {{"bufferView", 0},
         {"componentType", kFloat},
         {"count", vertices.source.size()},
         {"type", "VEC3"},
         {"min", box.low},
         {"max", box.high}},
        {{"bufferView", 1}, {"componentType", kUnsigned32}, {"count", vertices.indices.size()}, {"type", "SCALAR"}}};
    if (!vertices.colors.empty()) {
        primitive["attributes"]["COLOR_0"] = 2;
        gltf["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", positions}, {"byteLength", colors}, {"target", kVertexBuffer}});
        gltf["accessors"].push_back({{"bufferView", 2},
                                     {"componentType", kUnsigned16},
                                     {"normalized", true},
                                     {"count", vertices.colors.size()},
                                     {"type", "VEC4"}});
    }
    gltf["meshes"] = {{{"primitives", {primitive}}}};
    gltf["buffers"] = {{{"byteLength", positions + colors + indices}}};
    return gltf;
}

void append_chunk(std::string& out, std::uint32_t type, std::string bytes, char padding) {
    bytes.resize((bytes.size() + 3) / 4 * 4, padding);
    append_little(out, static_cast<std::uint32_t>(bytes.size()));
    append_little(out, type);
    out += bytes;
}

}  // namespace

std::string write_glb(const MeshToWrite& input) {
    check_mesh_to_write(input);
    const Vertices vertices = split_by_color(input);
    const std::string description =
        description_of(input, vertices).dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
    std::string body;
    append_chunk(body, kJsonChunk, description, ' ');
    append_chunk(body, kBinaryChunk, buffer_of(input, vertices), '\0');
    const std::size_t total = 12 + body.size();
    if (total > std::numeric_limits<std::uint32_t>::max())
        throw InvalidInput("GLB: " + std::to_string(total) + " bytes, expected less than 4 GiB");
    std::string out;
    out.reserve(total);
    append_little(out, kMagic);
    append_little(out, std::uint32_t{2});
    append_little(out, static_cast<std::uint32_t>(total));
    return out + body;
}

}  // namespace fretwork
