#include "core/fem/beam_wedge_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "core/base/parallel.h"
#include "core/fem/solid_elements.h"

namespace fretwork {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

/// One direction of a fan: an angle and the edges that leave there (none for virtual directions).
struct Face {
    double angle = 0.0;
    std::vector<EdgeIndex> edges;
};

struct Fan {
    Vec3 center_mm, normal, east, north;  ///< east, north span the tangent plane
    double radius_mm = 0.0;
    std::vector<Face> faces;  ///< ascending angles

    [[nodiscard]] Vec3 corner(std::size_t k) const {
        // Half way between face k and the next one.
        const double from = faces[k].angle;
        double to = faces[(k + 1) % faces.size()].angle;
        if (k + 1 == faces.size()) to += kTurn;
        const double angle = 0.5 * (from + to);
        return center_mm + radius_mm * (std::cos(angle) * east + std::sin(angle) * north);
    }
};

struct EdgeEnd {
    EdgeIndex edge;
    SampleIndex other;
};

/// Edges at each sample, in order of edges.
std::vector<std::vector<EdgeEnd>> edges_at_samples(const AbstractGraph& graph) {
    std::vector<std::vector<EdgeEnd>> ends(graph.samples.size());
    for (EdgeIndex e = 0; e < graph.edges.size(); ++e) {
        ends[graph.edges[e].a].push_back({e, graph.edges[e].b});
        ends[graph.edges[e].b].push_back({e, graph.edges[e].a});
    }
    return ends;
}

/// Groups sorted directions whose neighbours in angle are closer than `merge`; starts after the widest gap, so that no
/// group is cut in two.
std::vector<Face> merge_directions(std::vector<std::pair<double, EdgeIndex>> directions, double merge) {
    std::ranges::sort(directions);
    const std::size_t n = directions.size();
    std::size_t start = 0;
    double widest = -1.0;
    for (std::size_t k = 0; k < n; ++k) {
        const double previous = k == 0 ? directions[n - 1].first - kTurn : directions[k - 1].first;
        if (directions[k].first - previous > widest) {
            widest = directions[k].first - previous;
            start = k;
        }
    }
    std::vector<Face> faces;
    double group_begin = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const std::size_t k = (start + i) % n;
        const double angle = directions[k].first + (start + i >= n ? kTurn : 0.0);
        if (faces.empty() || angle - group_begin > merge) {
            faces.push_back({angle, {}});
            group_begin = angle;
        }
        faces.back().angle = 0.5 * (group_begin + angle);
        faces.back().edges.push_back(directions[k].second);
    }
    return faces;
}

/// Adds virtual directions until no wedge is wider than allowed.
std::vector<Face> close_fan(std::vector<Face> faces, double widest) {
    if (faces.empty()) faces.push_back({0.0, {}});
    std::vector<Face> closed;
    for (std::size_t k = 0; k < faces.size(); ++k) {
        const double from = faces[k].angle;
        const double to = k + 1 < faces.size() ? faces[k + 1].angle : faces[0].angle + kTurn;
        closed.push_back(std::move(faces[k]));
        const int parts = static_cast<int>(std::ceil((to - from) / widest - 1e-9));
        for (int i = 1; i < parts; ++i) closed.push_back({from + (to - from) * i / parts, {}});
    }
    return closed;
}

Fan make_fan(const SurfaceVoxels& shell, const AbstractGraph& graph, SampleIndex s, const std::vector<EdgeEnd>& ends,
             double half_width_voxels, const BeamGeometry& geometry) {
    Fan fan;
    fan.center_mm = shell.points_mm[graph.samples[s]];
    fan.normal = shell.normals[graph.samples[s]].cast<double>().normalized();
    fan.east = fan.normal.unitOrthogonal();
    fan.north = fan.normal.cross(fan.east);
    std::vector<std::pair<double, EdgeIndex>> directions;
    double shortest = std::numeric_limits<double>::infinity();
    for (const EdgeEnd& end : ends) {
        const Vec3 way = shell.points_mm[graph.samples[end.other]] - fan.center_mm;
        shortest = std::min(shortest, way.norm());
        directions.emplace_back(std::atan2(way.dot(fan.north), way.dot(fan.east)), end.edge);
    }
    const double by_width = geometry.radius_per_width * 2.0 * half_width_voxels * shell.grid.voxel_mm;
    fan.radius_mm = std::min(by_width, geometry.radius_per_edge * shortest);
    // Two samples at one surface point (sheets in one cell) must not make a fan of no size.
    fan.radius_mm = std::max(fan.radius_mm, 0.1 * shell.grid.voxel_mm);
    const double radians = std::numbers::pi / 180.0;
    fan.faces = close_fan(merge_directions(std::move(directions), geometry.merge_angle_deg * radians),
                          geometry.widest_wedge_deg * radians);
    return fan;
}

/// Nodes of one side of a fan: the right and the left one seen from the centre; bottoms, the tops follow each.
struct FanSide {
    NodeIndex right = 0, left = 0;
};

/// Appends the fan's nodes and wedges; tells each edge which side it leaves from.
void append_fan(const Fan& fan, SampleIndex s, double thickness_mm, BeamWedgeMesh& mesh, const AbstractGraph& graph,
                std::vector<std::array<FanSide, 2>>& sides) {
    const auto first = static_cast<NodeIndex>(mesh.nodes_mm.size());
    const Vec3 half_wall = 0.5 * thickness_mm * fan.normal;
    const auto add_pair = [&](const Vec3& middle) {
        mesh.nodes_mm.push_back(middle - half_wall);
        mesh.nodes_mm.push_back(middle + half_wall);
    };
    const std::size_t n = fan.faces.size();
    add_pair(fan.center_mm);
    for (std::size_t k = 0; k < n; ++k) add_pair(fan.corner(k));
    for (std::size_t k = 0; k < n; ++k) {
        // Face k lies between the corner before it (clockwise: its right) and its own (its left).
        const auto left = static_cast<NodeIndex>(first + 2 + 2 * k);
        const auto right = static_cast<NodeIndex>(first + 2 + 2 * ((k + n - 1) % n));
        mesh.wedges.push_back({{first, right, left, first + 1, right + 1, left + 1}, s});
        for (const EdgeIndex e : fan.faces[k].edges) sides[e][graph.edges[e].a == s ? 0 : 1] = {right, left};
    }
    mesh.first_node.push_back(static_cast<std::uint32_t>(mesh.nodes_mm.size()));
}

Corners<8> corners_of(const BeamWedgeMesh& mesh, const std::array<NodeIndex, 8>& nodes) {
    Corners<8> corners;
    for (int n = 0; n < 8; ++n) corners.col(n) = mesh.nodes_mm[nodes[static_cast<std::size_t>(n)]];
    return corners;
}

Beam join_sides(const BeamWedgeMesh& mesh, const FanSide& at_a, const FanSide& at_b) {
    // What is left seen from b is right seen along the edge. Where the normals at a and b oppose, top and bottom and
    // right and left both change places.
    const std::array<NodeIndex, 8> straight{at_a.right,     at_b.left,     at_b.right,     at_a.left,
                                            at_a.right + 1, at_b.left + 1, at_b.right + 1, at_a.left + 1};
    const std::array<NodeIndex, 8> turned{at_a.right,     at_b.right + 1, at_b.left + 1, at_a.left,
                                          at_a.right + 1, at_b.right,     at_b.left,     at_a.left + 1};
    const double straight_jacobian = least_jacobian(corners_of(mesh, straight));
    const double turned_jacobian =
        straight_jacobian > 0.0 ? straight_jacobian : least_jacobian(corners_of(mesh, turned));
    const bool turn = turned_jacobian > straight_jacobian;
    Beam beam;
    beam.nodes = turn ? turned : straight;
    beam.folds = !((turn ? turned_jacobian : straight_jacobian) > 0.0);
    const auto length = [&](const FanSide& side) {
        return (mesh.nodes_mm[side.left] - mesh.nodes_mm[side.right]).norm();
    };
    beam.width_mm = 0.5 * (length(at_a) + length(at_b));
    return beam;
}

}  // namespace

BeamWedgeMesh build_beam_wedge_mesh(const SurfaceVoxels& shell, const AbstractGraph& graph,
                                    std::span<const float> half_width_voxels, const BeamGeometry& geometry) {
    const std::vector<std::vector<EdgeEnd>> ends = edges_at_samples(graph);
    BeamWedgeMesh mesh;
    mesh.first_node.push_back(0);
    std::vector<std::array<FanSide, 2>> sides(graph.edges.size());
    for (SampleIndex s = 0; s < graph.samples.size(); ++s) {
        const Fan fan = make_fan(shell, graph, s, ends[s], half_width_voxels[s], geometry);
        append_fan(fan, s, geometry.thickness_mm, mesh, graph, sides);
    }
    mesh.beams.resize(graph.edges.size());
    parallel_for(mesh.beams.size(), 128,
                 [&](std::size_t e) { mesh.beams[e] = join_sides(mesh, sides[e][0], sides[e][1]); });
    for (const Beam& beam : mesh.beams) mesh.folded_beams += beam.folds ? 1u : 0u;
    return mesh;
}

void add_ties(const std::vector<SheetTie>& ties, BeamWedgeMesh& mesh) {
    // Two corners of a fan that lie about opposite, so that the middle of their nodes is about the sample.
    const auto corners = [&](SampleIndex s) {
        const std::uint32_t first = mesh.first_node[s] + 2;
        const std::uint32_t count = (mesh.first_node[s + 1] - first) / 2;
        return std::pair<NodeIndex, NodeIndex>(first, first + 2 * (count / 2));
    };
    for (const SheetTie& tie : ties) {
        const auto [a0, a1] = corners(tie.a);
        const auto [b0, b1] = corners(tie.b);
        mesh.ties.push_back({{a0, b0, b1, a1, a0 + 1, b0 + 1, b1 + 1, a1 + 1}, std::sqrt(tie.area_mm2)});
    }
}

}  // namespace fretwork
