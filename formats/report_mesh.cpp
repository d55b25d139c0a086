#include "formats/report_mesh.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <vector>

#include "core/base/error.h"
#include "formats/byte_order.h"
#include "formats/html_text.h"

namespace fretwork {
namespace {

constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();

void check(const ReportMesh& mesh) {
    const std::size_t triangles = mesh.mesh.triangles.size();
    for (const std::size_t count : {mesh.bridge.size(), mesh.stress_before.size(), mesh.stress_after.size()})
        if (count != triangles)
            throw InvalidInput(
                fmt::format("report: found {} facts for {} triangles, expected one each", count, triangles));
    if (mesh.vertex_colors.size() != mesh.mesh.positions_mm.size())
        throw InvalidInput(fmt::format("report: found {} colours for {} vertices, expected one each",
                                       mesh.vertex_colors.size(), mesh.mesh.positions_mm.size()));
}

/// Vertices that triangles use, in order of first use.
struct Packed {
    std::vector<Vec3> positions;
    std::string tints;  ///< three bytes per vertex
    std::vector<std::uint32_t> index;
};

Packed used_vertices(const TriangleMesh& mesh, const std::vector<Rgb8>& vertex_colors) {
    Packed packed;
    std::vector<std::uint32_t> number(mesh.positions_mm.size(), kUnused);
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) {
            if (number[v] == kUnused) {
                number[v] = static_cast<std::uint32_t>(packed.positions.size());
                packed.positions.push_back(mesh.positions_mm[v]);
                for (const std::uint8_t channel : vertex_colors[v]) packed.tints += static_cast<char>(channel);
            }
            packed.index.push_back(number[v]);
        }
    return packed;
}

std::string palette_bytes() {
    std::string bytes;
    for (int i = 0; i < 256; ++i)
        for (const std::uint8_t channel : stress_color(std::max(0, i - 1) / 254.0)) bytes += static_cast<char>(channel);
    return bytes;
}

std::string fact_bytes(const ReportMesh& mesh) {
    std::string bytes;
    for (std::size_t t = 0; t < mesh.bridge.size(); ++t) {
        bytes += static_cast<char>(mesh.bridge[t]);
        bytes += static_cast<char>(mesh.stress_before[t]);
        bytes += static_cast<char>(mesh.stress_after[t]);
    }
    return bytes;
}

}  // namespace

std::string report_mesh_json(const ReportMesh& mesh) {
    check(mesh);
    const Packed packed = used_vertices(mesh.mesh, mesh.vertex_colors);
    Vec3 low = Vec3::Zero(), high = Vec3::Zero();
    if (!packed.positions.empty()) low = high = packed.positions.front();
    for (const Vec3& p : packed.positions) {
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
    }
    std::string positions, triangles;
    for (const Vec3& p : packed.positions)
        for (int k = 0; k < 3; ++k) {
            const double side = high[k] - low[k];
            const double place = side > 0.0 ? (p[k] - low[k]) / side : 0.0;
            append_little(positions, static_cast<std::uint16_t>(std::lround(65535.0 * place)));
        }
    const bool wide = packed.positions.size() > std::numeric_limits<std::uint16_t>::max();
    for (const std::uint32_t v : packed.index) {
        if (wide)
            append_little(triangles, v);
        else
            append_little(triangles, static_cast<std::uint16_t>(v));
    }
    return fmt::format(
        "{{\"box\":[{:.7g},{:.7g},{:.7g},{:.7g},{:.7g},{:.7g}],\"wide\":{},\"positions\":\"{}\",\"tints\":\"{}\","
        "\"triangles\":\"{}\","
        "\"facts\":\"{}\",\"palette\":\"{}\"}}",
        low[0], low[1], low[2], high[0], high[1], high[2], wide, base64(positions), base64(packed.tints),
        base64(triangles), base64(fact_bytes(mesh)), base64(palette_bytes()));
}

}  // namespace fretwork
