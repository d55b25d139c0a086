#include "core/mesh/repair.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>
#include <map>
#include <set>
#include <stop_token>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/components.h"
#include "core/mesh/mesh_report.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// What repair promises of every result, counted the slow way.
void check_sound(const TriangleMesh& mesh) {
    std::map<Edge, int> directed;
    std::set<Triangle> distinct;
    for (const Triangle& t : mesh.triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++directed[{t[k], t[(k + 1) % 3]}];
        Triangle sorted = t;
        std::sort(sorted.begin(), sorted.end());
        CHECK(distinct.insert(sorted).second);
        const Vec3 &a = mesh.positions_mm[t[0]], &b = mesh.positions_mm[t[1]], &c = mesh.positions_mm[t[2]];
        const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
        CHECK((b - a).cross(c - a).norm() > 1e-12 * longest * longest);
    }
    for (const auto& [edge, count] : directed) {
        CHECK(edge.first != edge.second);
        CHECK(count == 1);  // at most one triangle each way: manifold and of one turn
    }
    const MeshReport report = report_mesh(mesh);
    CHECK(report.non_manifold_vertices == 0);
    CHECK(report.non_manifold_edges == 0);
    CHECK(report.flipped_edges == 0);
}

std::size_t border_edges(const TriangleMesh& mesh) {
    return report_mesh(mesh).border_edges;
}

TEST_CASE("repair: a clean mesh comes back as it is", "[mesh]") {
    for (const TriangleMesh& mesh : {make_bracket(), make_vase(60), make_linked_tori(20, 5), make_open_bowl(10, 8, 24),
                                     make_nested_spheres(10, 5, 2)}) {
        const RepairedMesh repaired = repair_mesh(mesh);
        CHECK(repaired.mesh.positions_mm == mesh.positions_mm);
        CHECK(repaired.mesh.triangles == mesh.triangles);
        RepairCounts expected;
        expected.components = repaired.counts.components;
        expected.open_components = repaired.counts.open_components;
        expected.border_edges = repaired.counts.border_edges;
        CHECK(repaired.counts == expected);
    }
    CHECK(describe(repair_mesh(make_vase(60)).counts).empty());
}

TEST_CASE("repair: every mess of a closed mesh becomes the closed mesh again", "[mesh][property]") {
    const std::vector<std::pair<const char*, TriangleMesh>> solids = {
        {"box", make_box(Vec3(0, 0, 0), Vec3(3, 4, 5), {2, 3, 2})},
        {"bracket", make_bracket()},
        {"torus", make_torus(10, 3, 24, 12)},
        {"frame", make_frame(30, 6, 1)},
        {"linked tori", make_linked_tori(20, 5, 24, 12)},
        {"hollow ball", make_nested_spheres(10, 5, 2)},
        {"thin plate", make_thin_plate(40, 30, 0.5, 6)},
    };
    const auto seed = GENERATE(range(1u, 4u));
    for (const auto& [name, solid] : solids) {
        CAPTURE(name, seed);
        const std::vector<std::pair<const char*, TriangleMesh>> messes = {
            {"soup", as_soup(solid)},
            {"shuffled", shuffled(solid, seed)},
            {"inverted", inverted(solid)},
            {"flipped", with_flipped(solid, 2 + seed)},
            {"duplicates", with_duplicates(solid, 5 * seed)},
            {"degenerate", with_degenerates(solid, 6 + seed)},
            {"all", as_soup(shuffled(with_degenerates(with_duplicates(with_flipped(solid, 3), 7), 5), seed))},
        };
        for (const auto& [mess, mesh] : messes) {
            CAPTURE(mess);
            const RepairedMesh repaired = repair_mesh(mesh);
            check_sound(repaired.mesh);
            CHECK(border_edges(repaired.mesh) == 0);
            CHECK(repaired.mesh.triangles.size() == solid.triangles.size());
            CHECK(repaired.mesh.positions_mm.size() == solid.positions_mm.size());
            CHECK(volume_mm3(repaired.mesh) == Approx(volume_mm3(solid)).epsilon(1e-9));
            CHECK(repaired.counts.components == find_components(solid).count);
        }
    }
}

TEST_CASE("repair: counts say what was done", "[mesh]") {
    const TriangleMesh box = make_box(Vec3::Zero(), Vec3(1, 2, 3));
    CHECK(repair_mesh(as_soup(box)).counts.welded_vertices == 36 - 8);
    CHECK(repair_mesh(with_flipped(box, 6)).counts.turned_triangles == 2);
    CHECK(repair_mesh(with_duplicates(box, 5)).counts.duplicate_triangles == 5);
    CHECK(repair_mesh(with_degenerates(box, 6)).counts.degenerate_triangles == 6);
    CHECK(repair_mesh(inverted(box)).counts.inverted_components == 1);
    CHECK(repair_mesh(inverted(make_linked_tori(20, 5, 24, 12))).counts.inverted_components == 2);
    CHECK(repair_mesh(make_open_bowl(10, 4, 12)).counts.border_edges == 12);
    TriangleMesh extra = box;
    extra.positions_mm.emplace_back(9, 9, 9);
    CHECK(repair_mesh(extra).counts.unused_vertices == 1);
    CHECK(describe(repair_mesh(with_duplicates(box, 1)).counts) ==
          std::vector<std::string>{"1 duplicate triangle was dropped"});
}

TEST_CASE("repair: each triangle names the triangle it came from", "[mesh]") {
    const TriangleMesh mesh = as_soup(with_degenerates(with_duplicates(make_bracket(), 9), 9));
    const RepairedMesh repaired = repair_mesh(mesh);
    REQUIRE(repaired.source_triangles.size() == repaired.mesh.triangles.size());
    for (std::size_t t = 0; t < repaired.mesh.triangles.size(); ++t) {
        std::set<std::array<double, 3>> now, then;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec3& p = repaired.mesh.positions_mm[repaired.mesh.triangles[t][k]];
            const Vec3& q = mesh.positions_mm[mesh.triangles[repaired.source_triangles[t]][k]];
            now.insert({p[0], p[1], p[2]});
            then.insert({q[0], q[1], q[2]});
        }
        CHECK(now == then);
    }
}

TEST_CASE("repair: a flat triangle between neighbours leaves no crack", "[mesh]") {
    // One edge of a box has a vertex in its middle on one side only; a triangle without width fills the T.
    TriangleMesh mesh = make_box(Vec3::Zero(), Vec3(2, 2, 2));
    const Triangle split = mesh.triangles[0];
    const Vec3 middle = 0.5 * (mesh.positions_mm[split[0]] + mesh.positions_mm[split[1]]);
    const auto m = static_cast<std::uint32_t>(mesh.positions_mm.size());
    mesh.positions_mm.push_back(middle);
    mesh.triangles[0] = {split[0], m, split[2]};
    mesh.triangles.push_back({m, split[1], split[2]});
    mesh.triangles.push_back({split[0], split[1], m});
    REQUIRE(border_edges(mesh) == 0);
    const RepairedMesh repaired = repair_mesh(mesh);
    check_sound(repaired.mesh);
    CHECK(border_edges(repaired.mesh) == 0);
    CHECK(repaired.counts.degenerate_triangles == 1);
    CHECK(repaired.mesh.triangles.size() == 14);
    CHECK(volume_mm3(repaired.mesh) == Approx(8.0));
}

TEST_CASE("repair: a chain of flat triangles and a needle leave no crack", "[mesh]") {
    // The fan of a flat polygon with all its corners but two on one line, and a sliver whose short side is tiny.
    TriangleMesh mesh;
    mesh.positions_mm = {{0, 0, 0}, {4, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {2, 3, 0}, {2, -3, 0}, {2, 0, 3}};
    // Upper side sees the fine edge 0-2-3-4-1, lower side the coarse edge 0-1; flat triangles join them.
    mesh.triangles = {{0, 2, 5}, {2, 3, 5}, {3, 4, 5}, {4, 1, 5}, {1, 0, 6}, {0, 1, 3}, {0, 3, 2}, {3, 1, 4}};
    mesh.triangles.insert(mesh.triangles.end(), {{0, 5, 7}, {5, 1, 7}, {6, 0, 7}, {1, 6, 7}});
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
    const std::size_t before = border_edges(mesh);
    const RepairedMesh repaired = repair_mesh(mesh);
    check_sound(repaired.mesh);
    CHECK(before == 0);
    CHECK(border_edges(repaired.mesh) == 0);
    CHECK(volume_mm3(repaired.mesh) == Approx(std::abs(volume_mm3(mesh))));

    TriangleMesh needle = make_box(Vec3::Zero(), Vec3(1, 1, 1));
    const Triangle t = needle.triangles[0];
    const auto twin = static_cast<std::uint32_t>(needle.positions_mm.size());
    needle.positions_mm.push_back(needle.positions_mm[t[0]] + Vec3(1e-13, 1e-13, 1e-13));
    needle.triangles[0] = {twin, t[1], t[2]};
    needle.triangles.push_back({t[0], t[1], twin});
    needle.triangles.push_back({t[2], t[0], twin});
    REQUIRE(border_edges(needle) == 0);
    const RepairedMesh mended = repair_mesh(needle);
    check_sound(mended.mesh);
    CHECK(mended.mesh.triangles.size() == 12);
    CHECK(border_edges(mended.mesh) == 0);
}

TEST_CASE("repair: solids that touch in an edge or a corner come apart closed", "[mesh]") {
    const RepairedMesh boxes = repair_mesh(make_boxes_sharing_edge());
    check_sound(boxes.mesh);
    CHECK(border_edges(boxes.mesh) == 0);
    CHECK(boxes.counts.components == 2);
    CHECK(boxes.counts.non_manifold_edges == 1);
    CHECK(boxes.counts.split_vertices == 2);
    CHECK(volume_mm3(boxes.mesh) == Approx(2.0));

    const RepairedMesh pinched = repair_mesh(make_pinched_vertex());
    check_sound(pinched.mesh);
    CHECK(border_edges(pinched.mesh) == 0);
    CHECK(pinched.counts.components == 2);
    CHECK(pinched.counts.split_vertices == 1);
    CHECK(volume_mm3(pinched.mesh) == Approx(1.0));
}

/// Hollows inside one block that touch along an edge: the material passes twice through the edge.
TriangleMesh block_with_touching_hollows() {
    TriangleMesh hollows = inverted(make_boxes_sharing_edge());
    return joined(make_box(Vec3(-1, -1, -1), Vec3(3, 3, 3)), hollows);
}

TEST_CASE("repair: hollows that touch in an edge stay closed", "[mesh]") {
    const RepairedMesh repaired = repair_mesh(block_with_touching_hollows());
    check_sound(repaired.mesh);
    CHECK(border_edges(repaired.mesh) == 0);
    CHECK(volume_mm3(repaired.mesh) == Approx(64.0 - 2.0));
}

TEST_CASE("repair: fins on one edge stay open", "[mesh]") {
    const RepairedMesh fins = repair_mesh(make_three_fins());
    check_sound(fins.mesh);
    CHECK(fins.mesh.triangles.size() == 3);
    CHECK(fins.counts.open_components == fins.counts.components);
}

TEST_CASE("repair: a Moebius band is cut and comes back of one turn", "[mesh]") {
    TriangleMesh band;
    const std::uint32_t n = 12;
    for (std::uint32_t i = 0; i < n; ++i) {
        const double angle = 2 * 3.141592653589793 * i / n;
        const Vec3 out(std::cos(angle), std::sin(angle), 0);
        const Vec3 across = std::cos(angle / 2) * Vec3::UnitZ() + std::sin(angle / 2) * out;
        band.positions_mm.push_back(5 * out - across);
        band.positions_mm.push_back(5 * out + across);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
        const bool last = i + 1 == n;
        const std::uint32_t a = 2 * i, b = 2 * i + 1, c = last ? 1 : 2 * i + 2, d = last ? 0 : 2 * i + 3;
        band.triangles.push_back({a, c, b});
        band.triangles.push_back({b, c, d});
    }
    const RepairedMesh repaired = repair_mesh(band);
    check_sound(repaired.mesh);
    CHECK(repaired.counts.one_sided_edges == 1);
    CHECK(repaired.mesh.triangles.size() >= band.triangles.size());
    CHECK(area_mm2(repaired.mesh) == Approx(area_mm2(band)));
}

TEST_CASE("repair: two boxes put together lose the wall between them", "[mesh]") {
    const TriangleMesh left = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1), {3, 3, 3});
    const TriangleMesh right = make_box(Vec3(1, 0, 0), Vec3(2, 1, 1), {3, 3, 3});
    const TriangleMesh both = joined(left, right);
    const RepairedMesh repaired = repair_mesh(both);
    check_sound(repaired.mesh);
    CHECK(border_edges(repaired.mesh) == 0);
    CHECK(repaired.counts.inner_wall_triangles == 36);
    CHECK(repaired.counts.components == 1);
    CHECK(volume_mm3(repaired.mesh) == Approx(2.0));
    CHECK(area_mm2(repaired.mesh) == Approx(10.0));
}

TEST_CASE("repair: a sheet given from both sides becomes one sheet", "[mesh]") {
    const TriangleMesh sheet = make_square(4, 4);
    const RepairedMesh repaired = repair_mesh(joined(sheet, inverted(sheet)));
    check_sound(repaired.mesh);
    CHECK(repaired.mesh.triangles.size() == sheet.triangles.size());
    CHECK(border_edges(repaired.mesh) == 16);
}

TEST_CASE("repair: nested pieces keep their turn towards the outermost", "[mesh]") {
    const double outer = volume_mm3(make_icosphere(10, 2)), inner = volume_mm3(make_icosphere(5, 2)),
                 core = volume_mm3(make_icosphere(2, 2));
    const TriangleMesh hollow = make_nested_spheres(10, 5, 2);
    CHECK(volume_mm3(repair_mesh(inverted(hollow)).mesh) == Approx(outer - inner));
    const TriangleMesh kernel = joined(hollow, make_icosphere(2, 2));
    CHECK(volume_mm3(repair_mesh(kernel).mesh) == Approx(outer - inner + core));
    CHECK(volume_mm3(repair_mesh(inverted(kernel)).mesh) == Approx(outer - inner + core));
    const TriangleMesh ball_in_ball = joined(make_icosphere(5, 2), make_icosphere(10, 2));
    CHECK(volume_mm3(repair_mesh(ball_in_ball).mesh) == Approx(outer + inner));
    // Side by side, only the one that is inside out is turned.
    const TriangleMesh pair = joined(make_icosphere(5, 2), inverted(make_icosphere(5, 2, Vec3(20, 0, 0))));
    CHECK(volume_mm3(repair_mesh(pair).mesh) == Approx(2 * inner));
    CHECK(repair_mesh(pair).counts.inverted_components == 1);
}

TEST_CASE("repair: cracks of rounding close, gaps stay", "[mesh]") {
    TriangleMesh soup = as_soup(make_torus(10, 3, 24, 12));
    for (std::size_t v = 0; v < soup.positions_mm.size(); ++v)
        soup.positions_mm[v] = soup.positions_mm[v].cast<float>().cast<double>() +
                               1e-6 * Vec3(double(v % 3) - 1, double(v % 5) - 2, double(v % 7) - 3);
    const RepairedMesh closed = repair_mesh(soup);
    check_sound(closed.mesh);
    CHECK(border_edges(closed.mesh) == 0);
    CHECK(closed.counts.border_welds > 0);
    CHECK(border_edges(repair_mesh(soup, {.weld_mm = 1e-9}).mesh) == soup.triangles.size() * 3);
    const TriangleMesh two = joined(make_square(1), translated(make_square(1), Vec3(1.01, 0, 0)));
    CHECK(repair_mesh(two).counts.components == 2);
    CHECK(repair_mesh(two, {.weld_mm = 0.02}).counts.components == 1);
}

TEST_CASE("repair: random soups on few vertices come out sound", "[mesh][property]") {
    const auto seed = GENERATE(range(1u, 41u));
    CAPTURE(seed);
    // Triangles between the points of a tiny lattice: full of duplicates, flats, folds and non-manifold edges.
    TriangleMesh mesh = random_soup(seed, 20 + 10 * (seed % 12), 1.0);
    const double steps = 1.0 + seed % 3;
    for (Vec3& p : mesh.positions_mm)
        for (int axis = 0; axis < 3; ++axis) p[axis] = std::round(p[axis] * steps) / steps;
    const RepairedMesh repaired = repair_mesh(mesh);
    check_sound(repaired.mesh);
    const RepairedMesh again = repair_mesh(repaired.mesh);
    CHECK(again.mesh.triangles.size() >= repaired.mesh.triangles.size());
}

TEST_CASE("repair: same result for one thread and many, and on every run", "[mesh]") {
    const TriangleMesh mesh = as_soup(shuffled(with_duplicates(make_linked_tori(20, 5), 50), 3));
    const RepairedMesh first = repair_mesh(mesh);
    const ThreadLimit one(1);
    const RepairedMesh second = repair_mesh(mesh);
    CHECK(first.mesh.positions_mm == second.mesh.positions_mm);
    CHECK(first.mesh.triangles == second.mesh.triangles);
    CHECK(first.source_triangles == second.source_triangles);
}

TEST_CASE("repair: bad input is refused by name", "[mesh]") {
    const TriangleMesh box = make_box(Vec3::Zero(), Vec3(1, 1, 1));
    const auto refused = [](const TriangleMesh& mesh, const std::string& says) {
        CAPTURE(says);
        CHECK_THROWS_WITH(repair_mesh(mesh), Catch::Contains(says));
        CHECK_THROWS_AS(repair_mesh(mesh), InvalidInput);
    };
    refused({}, "no triangles");
    refused({box.positions_mm, {}}, "no triangles");
    TriangleMesh bad = box;
    bad.triangles[7][2] = 8;
    refused(bad, "triangle 7 names vertex 8, but the mesh has 8 vertices");
    for (const double x : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300}) {
        bad = box;
        bad.positions_mm[3][1] = x;
        refused(bad, "coordinate y of vertex 3");
    }
    refused({{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}}, {{0, 1, 2}, {0, 0, 1}}}, "all 2 triangles have zero area");
    refused({{{0, 0, 0}, {0.1, 0.2, 0.3}, {0.2, 0.4, 0.6}, {0.3, 0.6, 0.9}}, {{0, 1, 2}, {1, 2, 3}}}, "zero area");
    CHECK_THROWS_AS(repair_mesh(box, {.weld_mm = -1.0}), InvalidSetting);
    CHECK_THROWS_AS(repair_mesh(box, {.weld_mm = std::numeric_limits<double>::quiet_NaN()}), InvalidSetting);
}

TEST_CASE("repair: stops when asked and reports progress that never falls", "[mesh]") {
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(repair_mesh(make_vase(60), {}, RunControl({}, source.get_token())), Cancelled);
    double last = -1.0;
    bool rising = true;
    repair_mesh(make_vase(60), {}, RunControl([&](std::string_view, double share) {
                    rising = rising && share >= last;
                    last = share;
                }));
    CHECK(rising);
    CHECK(last == 1.0);
}

}  // namespace
}  // namespace fretwork
