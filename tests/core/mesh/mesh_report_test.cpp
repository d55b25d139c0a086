#include "core/mesh/mesh_report.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <numbers>
#include <set>
#include <stop_token>
#include <vector>

#include "core/base/error.h"
#include "core/mesh/components.h"
#include "core/mesh/self_intersections.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Flood over triangles that `touch`, the slow way.
template <class Touch>
std::size_t count_pieces(const TriangleMesh& mesh, std::vector<std::uint32_t> members, const Touch& touch) {
    std::size_t pieces = 0;
    while (!members.empty()) {
        ++pieces;
        std::vector<std::uint32_t> front = {members.back()};
        members.pop_back();
        while (!front.empty()) {
            const std::uint32_t t = front.back();
            front.pop_back();
            for (std::size_t i = 0; i < members.size();)
                if (touch(mesh.triangles[t], mesh.triangles[members[i]])) {
                    front.push_back(members[i]);
                    members.erase(members.begin() + static_cast<std::ptrdiff_t>(i));
                } else {
                    ++i;
                }
        }
    }
    return pieces;
}

int shared_vertices(const Triangle& s, const Triangle& t) {
    int shared = 0;
    for (const std::uint32_t v : s) shared += std::count(t.begin(), t.end(), v) > 0 ? 1 : 0;
    return shared;
}

MeshReport naive_report(const TriangleMesh& mesh) {
    MeshReport report;
    std::map<Edge, std::vector<int>> edges;
    std::map<Triangle, int> copies;
    std::vector<std::uint32_t> all;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
        const Triangle& t = mesh.triangles[i];
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = t[k], b = t[(k + 1) % 3];
            edges[std::minmax(a, b)].push_back(a < b ? 1 : -1);
        }
        Triangle sorted = t;
        std::sort(sorted.begin(), sorted.end());
        report.duplicate_triangles += copies[sorted]++ > 0 ? 1 : 0;
        all.push_back(i);
    }
    for (const auto& [edge, turns] : edges) {
        report.border_edges += turns.size() == 1 ? 1 : 0;
        report.non_manifold_edges += turns.size() > 2 ? 1 : 0;
        report.flipped_edges += turns.size() == 2 && turns[0] == turns[1] ? 1 : 0;
    }
    report.components = count_pieces(mesh, all, [](auto& s, auto& t) { return shared_vertices(s, t) >= 2; });
    for (std::uint32_t v = 0; v < mesh.positions_mm.size(); ++v) {
        std::vector<std::uint32_t> around;
        for (const std::uint32_t t : all)
            if (std::count(mesh.triangles[t].begin(), mesh.triangles[t].end(), v) > 0) around.push_back(t);
        const std::size_t fans = count_pieces(mesh, around, [&](const Triangle& s, const Triangle& t) {
            return shared_vertices(s, t) >= 2;  // both hold v, so they share an edge at v
        });
        report.non_manifold_vertices += fans > 1 ? 1 : 0;
    }
    return report;
}

void check_counts(const TriangleMesh& mesh) {
    const MeshReport fast = report_mesh(mesh), slow = naive_report(mesh);
    CHECK(fast.border_edges == slow.border_edges);
    CHECK(fast.non_manifold_edges == slow.non_manifold_edges);
    CHECK(fast.flipped_edges == slow.flipped_edges);
    CHECK(fast.non_manifold_vertices == slow.non_manifold_vertices);
    CHECK(fast.duplicate_triangles == slow.duplicate_triangles);
    CHECK(fast.components == slow.components);
}

TEST_CASE("mesh report: counts agree with naive counting on tangled meshes", "[mesh][property]") {
    const auto seed = GENERATE(range(1u, 31u));
    CAPTURE(seed);
    // Triangles between few vertices share edges in every way there is.
    const std::uint32_t vertices = 5 + seed % 9;
    TriangleMesh mesh = random_soup(seed, 4 + seed, 1.0);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        Triangle& k = mesh.triangles[t];
        for (std::uint32_t i = 0; i < 3; ++i)
            k[i] = static_cast<std::uint32_t>(1e6 * (1 + mesh.positions_mm[3 * t + i][0])) % vertices;
        if (k[1] == k[0]) k[1] = (k[0] + 1) % vertices;
        while (k[2] == k[0] || k[2] == k[1]) k[2] = (k[2] + 1) % vertices;
    }
    check_counts(mesh);
}

TEST_CASE("mesh report: counts agree with naive counting on known faults", "[mesh]") {
    for (const TriangleMesh& mesh : {make_square(4, 3), make_boxes_sharing_edge(), make_three_fins(),
                                     make_pinched_vertex(), with_flipped(make_box(Vec3::Zero(), Vec3(1, 1, 1)), 5),
                                     with_duplicates(make_square(2, 2), 3), as_soup(make_square(2, 2))})
        check_counts(mesh);
}

TEST_CASE("mesh report: a closed box", "[mesh]") {
    const MeshReport report = report_mesh(make_box(Vec3(100, 0, 0), Vec3(102, 3, 4)), CountSelfIntersections::kYes);
    CHECK(report.vertices == 8);
    CHECK(report.triangles == 12);
    CHECK(report.min_mm == Vec3(100, 0, 0));
    CHECK(report.max_mm == Vec3(102, 3, 4));
    CHECK(report.area_mm2 == Approx(2 * (6 + 8 + 12)));
    CHECK(report.volume_mm3 == Approx(24));
    CHECK(report.components == 1);
    CHECK(report.closed_manifold());
    CHECK(report.self_intersections_counted);
    CHECK(report.self_intersections == 0);
    CHECK_FALSE(report_mesh(make_square(1)).closed_manifold());
    CHECK(report_mesh(inverted(make_vase(60))).volume_mm3 == Approx(-vase_volume_mm3(60)));
    CHECK(report_mesh(with_degenerates(make_square(1), 7)).degenerate_triangles == 7);
}

TEST_CASE("self-intersections: none in sound meshes, known pairs in others", "[mesh]") {
    for (const TriangleMesh& mesh :
         {make_bracket(), make_vase(60), make_torus(10, 3, 32, 16), make_linked_tori(20, 5), make_frame(30, 6),
          make_nested_spheres(10, 5, 3), make_square(4, 4), make_open_bowl(10, 8, 24), make_three_fins(),
          rotated(make_bracket(), Vec3(1, 2, 3), 0.7)})
        CHECK(find_self_intersections(mesh).empty());
    CHECK(find_self_intersections(make_crossing_pair()).size() == 1);
    CHECK(find_self_intersections(with_duplicates(make_square(1), 2)).size() == 2);
    // Sheets that touch: told apart by index they meet, by position they are joined.
    const TriangleMesh soup = as_soup(make_vase(60, 16, 8));
    CHECK(find_self_intersections(soup).size() > soup.triangles.size());
    CHECK(find_self_intersections(soup, {}, JoinedBy::kPosition).empty());
    CHECK(find_self_intersections(as_soup(make_crossing_pair()), {}, JoinedBy::kPosition).size() == 1);
    // Folded back over a shared edge, in one plane.
    const TriangleMesh folded = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.2, 0.5, 0}}, {{0, 1, 2}, {0, 3, 1}}};
    CHECK(find_self_intersections(folded).size() == 1);
    // One shared vertex, the rest passing through.
    const TriangleMesh poked = {{{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0.3, 1}, {1, 0.4, -1}}, {{0, 1, 2}, {0, 3, 4}}};
    CHECK(find_self_intersections(poked).size() == 1);
}

/// Whether a segment passes properly through a triangle, in plain arithmetic; fit for points in general position.
bool passes(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, const Vec3& c) {
    const auto side = [](const Vec3& u, const Vec3& v, const Vec3& w, const Vec3& x) {
        return (v - u).cross(w - u).dot(x - u) > 0;
    };
    if (side(a, b, c, p) == side(a, b, c, q)) return false;
    const bool ab = side(p, q, a, b), bc = side(p, q, b, c), ca = side(p, q, c, a);
    return ab == bc && bc == ca;
}

TEST_CASE("self-intersections: pairs agree with trying all pairs", "[mesh][property]") {
    const auto seed = GENERATE(range(1u, 7u));
    CAPTURE(seed);
    const TriangleMesh mesh = random_soup(seed, 120, 10.0);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
        for (std::uint32_t j = i + 1; j < mesh.triangles.size(); ++j) {
            bool meet = false;
            const Vec3 *s = &mesh.positions_mm[3 * i], *t = &mesh.positions_mm[3 * j];
            for (int k = 0; k < 3; ++k)
                meet = meet || passes(s[k], s[(k + 1) % 3], t[0], t[1], t[2]) ||
                       passes(t[k], t[(k + 1) % 3], s[0], s[1], s[2]);
            if (meet) expected.emplace_back(i, j);
        }
    CHECK(expected.size() > 50);
    CHECK(find_self_intersections(mesh) == expected);

    // Asked about every third triangle only: the pairs with one of those.
    std::vector<std::uint32_t> among;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); t += 3) among.push_back(t);
    std::erase_if(expected, [](const auto& pair) { return pair.first % 3 != 0 && pair.second % 3 != 0; });
    CHECK(expected.size() > 20);
    CHECK(find_self_intersections_among(mesh, among) == expected);
}

TEST_CASE("mesh report: bad input is refused, a stop is honoured", "[mesh]") {
    CHECK_THROWS_AS(report_mesh({}), InvalidInput);
    TriangleMesh bad = make_square(1);
    bad.triangles[1][1] = 99;
    CHECK_THROWS_WITH(report_mesh(bad), Catch::Contains("triangle 1 names vertex 99"));
    bad = make_square(1);
    bad.positions_mm[2][0] = std::numeric_limits<double>::infinity();
    CHECK_THROWS_WITH(report_mesh(bad), Catch::Contains("coordinate x of vertex 2"));
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(report_mesh(make_vase(60), CountSelfIntersections::kYes, RunControl({}, source.get_token())),
                    Cancelled);
}

TEST_CASE("components: by edge and by vertex, numbered by their lowest triangle", "[mesh]") {
    CHECK(find_components(make_linked_tori(20, 5)).count == 2);
    CHECK(find_components(make_pinched_vertex(), ConnectedBy::kEdge).count == 2);
    CHECK(find_components(make_pinched_vertex(), ConnectedBy::kVertex).count == 1);
    CHECK(find_components(as_soup(make_square(1, 3))).count == 18);
    CHECK(find_components({}).count == 0);
    const TriangleMesh three = shuffled(joined(make_linked_tori(20, 5, 12, 8), make_square(1, 2)), 5);
    const MeshComponents components = find_components(three);
    REQUIRE(components.count == 3);
    std::uint32_t seen = 0;
    for (const std::uint32_t c : components.of_triangle) {
        CHECK(c <= seen);
        seen = std::max(seen, c + 1);
    }
    CHECK_THROWS_AS(find_components({{Vec3::Zero()}, {{0, 0, 1}}}), InvalidInput);
}

TEST_CASE("components: the parts make up the whole", "[mesh]") {
    const TriangleMesh whole = shuffled(joined(make_linked_tori(20, 5, 12, 8), make_pinched_vertex()), 2);
    const std::vector<ComponentMesh> parts = split_components(whole, find_components(whole));
    REQUIRE(parts.size() == 4);
    double volume = 0.0;
    std::size_t triangles = 0;
    for (const ComponentMesh& part : parts) {
        volume += volume_mm3(part.mesh);
        triangles += part.mesh.triangles.size();
        CHECK(find_components(part.mesh).count == 1);
        CHECK(report_mesh(part.mesh).closed_manifold());
        CHECK(std::is_sorted(part.source_triangles.begin(), part.source_triangles.end()));
        for (std::size_t t = 0; t < part.mesh.triangles.size(); ++t)
            for (std::size_t k = 0; k < 3; ++k)
                CHECK(part.mesh.positions_mm[part.mesh.triangles[t][k]] ==
                      whole.positions_mm[whole.triangles[part.source_triangles[t]][k]]);
    }
    CHECK(triangles == whole.triangles.size());
    CHECK(volume == Approx(volume_mm3(whole)));
}

}  // namespace
}  // namespace fretwork
