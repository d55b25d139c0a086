#include "core/mesh/mesh_report.h"

#include <algorithm>
#include <vector>

#include "core/base/disjoint_sets.h"
#include "core/mesh/check_mesh.h"
#include "core/mesh/components.h"
#include "core/mesh/edge_table.h"
#include "core/mesh/self_intersections.h"
#include "core/mesh/triangle_math.h"

namespace fretwork {
namespace {

void measure(const TriangleMesh& mesh, MeshReport& report) {
    report.vertices = mesh.positions_mm.size();
    report.triangles = mesh.triangles.size();
    report.min_mm = report.max_mm = mesh.positions_mm[mesh.triangles[0][0]];
    // Volume about a corner of the mesh, so that one far from the origin loses no digits.
    const Vec3 origin = report.min_mm;
    for (const Triangle& t : mesh.triangles) {
        const Vec3 a = mesh.positions_mm[t[0]], b = mesh.positions_mm[t[1]], c = mesh.positions_mm[t[2]];
        report.min_mm = report.min_mm.cwiseMin(a).cwiseMin(b).cwiseMin(c);
        report.max_mm = report.max_mm.cwiseMax(a).cwiseMax(b).cwiseMax(c);
        report.area_mm2 += 0.5 * (b - a).cross(c - a).norm();
        report.volume_mm3 += (a - origin).dot((b - origin).cross(c - origin)) / 6.0;
        if (is_degenerate(a, b, c)) ++report.degenerate_triangles;
    }
}

void count_edges(const TriangleMesh& mesh, const EdgeTable& edges, MeshReport& report) {
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto half_edges = edges.half_edges(e);
        if (half_edges.size() == 1) ++report.border_edges;
        if (half_edges.size() > 2) ++report.non_manifold_edges;
        if (half_edges.size() == 2 && runs_up(mesh, half_edges[0]) == runs_up(mesh, half_edges[1]))
            ++report.flipped_edges;
    }
}

/// Vertices at which the triangles form more than one fan: corners joined over the edges at the vertex.
std::size_t count_split_vertices(const TriangleMesh& mesh, const EdgeTable& edges) {
    DisjointSets corners(3 * mesh.triangles.size());
    const auto corner_at = [&](HalfEdge h, std::uint32_t v) {
        return start_of(mesh, h) == v ? h : next_in_triangle(h);
    };
    for (std::size_t e = 0; e < edges.size(); ++e) {
        const auto half_edges = edges.half_edges(e);
        for (const HalfEdge h : half_edges)
            for (const std::uint32_t v : {edges.low(e), edges.high(e)})
                corners.unite(corner_at(half_edges[0], v), corner_at(h, v));
    }
    std::vector<std::uint8_t> fans(mesh.positions_mm.size(), 0);
    std::size_t count = 0;
    for (std::uint32_t c = 0; c < 3 * mesh.triangles.size(); ++c) {
        const Triangle& t = mesh.triangles[c / 3];
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || corners.find(c) != c) continue;
        std::uint8_t& n = fans[t[c % 3]];
        if (n == 1) ++count;
        if (n < 2) ++n;
    }
    return count;
}

std::size_t count_duplicates(const TriangleMesh& mesh) {
    std::vector<Triangle> sorted = mesh.triangles;
    for (Triangle& t : sorted) std::sort(t.begin(), t.end());
    std::sort(sorted.begin(), sorted.end());
    std::size_t count = 0;
    for (std::size_t i = 1; i < sorted.size(); ++i) count += sorted[i] == sorted[i - 1] ? 1 : 0;
    return count;
}

}  // namespace

MeshReport report_mesh(const TriangleMesh& mesh, CountSelfIntersections count, const RunControl& run) {
    check_mesh(mesh, "mesh report", ZeroArea::kAllowed);
    MeshReport report;
    measure(mesh, report);
    run.throw_if_stopped();
    const EdgeTable edges(mesh, run);
    count_edges(mesh, edges, report);
    run.throw_if_stopped();
    report.non_manifold_vertices = count_split_vertices(mesh, edges);
    report.components = find_components(mesh, edges).count;
    run.throw_if_stopped();
    report.duplicate_triangles = count_duplicates(mesh);
    if (count == CountSelfIntersections::kYes) {
        report.self_intersections = find_self_intersections(mesh, run).size();
        report.self_intersections_counted = true;
    }
    return report;
}

}  // namespace fretwork
