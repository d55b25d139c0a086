// Which triangle continues which over each edge.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/mesh/repair_steps.h"
#include "core/mesh/triangle_math.h"

namespace fretwork::repair {
namespace {

/// Directions round an edge, for sorting the triangles that meet in it.
struct EdgeFrame {
    EdgeFrame(const TriangleMesh& mesh, std::uint32_t low, std::uint32_t high) : origin(mesh.positions_mm[low]) {
        const Vec3 axis = (mesh.positions_mm[high] - origin).normalized();
        Vec3 least = Vec3::Zero();
        Eigen::Index k = 0;
        axis.cwiseAbs().minCoeff(&k);
        least[k] = 1.0;
        x = (least - axis.dot(least) * axis).normalized();
        y = axis.cross(x);
    }
    /// Counter-clockwise seen against the axis from low to high.
    [[nodiscard]] double angle(const Vec3& p) const { return std::atan2((p - origin).dot(y), (p - origin).dot(x)); }

    Vec3 origin, x, y;
};

struct Sheet {
    double angle;
    HalfEdge half_edge;
    bool up;  ///< runs from low to high: its material lies clockwise of it, else counter-clockwise
    bool operator<(const Sheet& other) const {
        return angle != other.angle ? angle < other.angle : half_edge < other.half_edge;
    }
};

/// Matches the sheets round one edge like brackets on a circle: a wedge of material opens with a sheet that runs down
/// and closes with the next free one that runs up.
void match_wedges(std::vector<Sheet>& sheets, std::vector<HalfEdge>& mates) {
    std::sort(sheets.begin(), sheets.end());
    std::vector<HalfEdge> opened;
    for (int lap = 0; lap < 2; ++lap)
        for (const Sheet& sheet : sheets) {
            if (mates[sheet.half_edge] != kNoMate) continue;
            if (!sheet.up) {
                if (lap == 0) opened.push_back(sheet.half_edge);
            } else if (!opened.empty()) {
                mates[sheet.half_edge] = opened.back();
                mates[opened.back()] = sheet.half_edge;
                opened.pop_back();
            }
        }
}

double area_of(const TriangleMesh& mesh, const Triangle& t) {
    const Vec3& a = mesh.positions_mm[t[0]];
    return 0.5 * (mesh.positions_mm[t[1]] - a).cross(mesh.positions_mm[t[2]] - a).norm();
}

}  // namespace

void agree_on_turn(Draft& draft) {
    TriangleMesh& mesh = draft.mesh;
    const EdgeTable edges(mesh, draft.run);
    std::vector<HalfEdge> across(3 * mesh.triangles.size(), kNoMate);
    for (std::size_t e = 0; e < edges.size(); ++e)
        if (const auto h = edges.half_edges(e); h.size() == 2) across[h[0]] = h[1], across[h[1]] = h[0];

    std::vector<std::uint8_t> seen(mesh.triangles.size(), 0), turn(mesh.triangles.size(), 0);
    std::vector<std::uint32_t> patch;
    for (std::uint32_t first = 0; first < mesh.triangles.size(); ++first) {
        if (first % kOften == 0) draft.run.throw_if_stopped();
        if (seen[first] != 0) continue;
        patch.assign(1, first);
        seen[first] = 1;
        double as_given = 0.0, turned = 0.0;
        for (std::size_t i = 0; i < patch.size(); ++i) {
            if (i % kOften == 0) draft.run.throw_if_stopped();
            const std::uint32_t t = patch[i];
            (turn[t] == 0 ? as_given : turned) += area_of(mesh, mesh.triangles[t]);
            for (HalfEdge h = 3 * t; h < 3 * t + 3; ++h) {
                const HalfEdge g = across[h];
                if (g == kNoMate || seen[g / 3] != 0) continue;
                seen[g / 3] = 1;
                turn[g / 3] = turn[t] ^ (runs_up(mesh, h) == runs_up(mesh, g) ? 1 : 0);
                patch.push_back(g / 3);
            }
        }
        if (turned > as_given)
            for (const std::uint32_t t : patch) turn[t] ^= 1;
    }
    for (std::size_t t = 0; t < turn.size(); ++t)
        if (turn[t] != 0) {
            std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
            ++draft.counts.turned_triangles;
        }
}

std::vector<HalfEdge> glue_half_edges(Draft& draft) {
    const TriangleMesh& mesh = draft.mesh;
    const EdgeTable edges(mesh, draft.run);
    std::vector<HalfEdge> mates(3 * mesh.triangles.size(), kNoMate);
    std::vector<Sheet> sheets;
    for (std::size_t e = 0; e < edges.size(); ++e) {
        if (e % kOften == 0) draft.run.throw_if_stopped();
        const auto h = edges.half_edges(e);
        if (h.size() == 2) {
            if (runs_up(mesh, h[0]) != runs_up(mesh, h[1]))
                mates[h[0]] = h[1], mates[h[1]] = h[0];
            else
                ++draft.counts.one_sided_edges;
        } else if (h.size() > 2) {
            ++draft.counts.non_manifold_edges;
            const EdgeFrame frame(mesh, edges.low(e), edges.high(e));
            sheets.clear();
            for (const HalfEdge g : h) {
                const std::uint32_t apex = end_of(mesh, next_in_triangle(g));
                sheets.push_back({frame.angle(mesh.positions_mm[apex]), g, runs_up(mesh, g)});
            }
            match_wedges(sheets, mates);
        }
    }
    return mates;
}

}  // namespace fretwork::repair
