#include "core/fem/beam_model.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/fem/beam_elements.h"
#include "core/fem/beam_wedge_mesh.h"
#include "core/fem/beam_widths.h"
#include "core/fem/facing_sheets.h"
#include "core/fem/pattern_case.h"
#include "core/fem/sample_loads.h"
#include "core/fem/solid_elements.h"
#include "core/graph/connect_samples.h"
#include "core/graph/poisson_disk.h"
#include "core/graph/shortest_path_forest.h"
#include "core/shell/voxelize.h"
#include "support/carved_shells.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::blob_case;
using testing::Case;
using testing::make_box;
using testing::make_case;
using testing::make_cylinder;
using testing::make_icosphere;
using testing::make_linked_tori;
using testing::make_square;
using testing::states_of;

template <int N, std::size_t M>
Corners<N> corners_of(const BeamWedgeMesh& mesh, const std::array<NodeIndex, M>& nodes) {
    Corners<N> corners;
    for (int n = 0; n < N; ++n) corners.col(n) = mesh.nodes_mm[nodes[static_cast<std::size_t>(n)]];
    return corners;
}

TEST_CASE("beam-wedge mesh: fans close without folding, beams join them face to face", "[fem][property]") {
    const auto seed = GENERATE(range(1u, 7u));
    CAPTURE(seed);
    const TriangleMesh mesh = seed % 3 == 0   ? make_box(Vec3::Zero(), Vec3(40, 30, 20))
                              : seed % 3 == 1 ? make_icosphere(20.0, 4)
                                              : make_linked_tori(20.0, 7.0);
    const Case c = blob_case(mesh, 48, seed, 120);
    BeamGeometry geometry;
    geometry.thickness_mm = 1.5;
    const BeamWedgeMesh fem =
        build_beam_wedge_mesh(c.shell, c.graph, std::vector<float>(c.graph.samples.size(), 3.0f), geometry);
    REQUIRE(fem.samples() == c.graph.samples.size());
    std::vector<int> wedges(fem.samples(), 0);
    for (const Wedge& wedge : fem.wedges) {
        ++wedges[wedge.sample];
        REQUIRE(least_jacobian(corners_of<6>(fem, wedge.nodes)) > 0.0);
    }
    for (SampleIndex s = 0; s < fem.samples(); ++s) {
        CHECK(wedges[s] >= 3);
        // A centre and as many corners as wedges, each twice.
        CHECK(fem.first_node[s + 1] - fem.first_node[s] == static_cast<std::uint32_t>(2 * (wedges[s] + 1)));
        // The angles of the wedges at the centre fill the circle.
        double angle = 0.0;
        for (const Wedge& wedge : fem.wedges) {
            if (wedge.sample != s) continue;
            const Vec3 right = (fem.nodes_mm[wedge.nodes[1]] - fem.nodes_mm[wedge.nodes[0]]).normalized();
            const Vec3 left = (fem.nodes_mm[wedge.nodes[2]] - fem.nodes_mm[wedge.nodes[0]]).normalized();
            angle += std::acos(std::clamp(right.dot(left), -1.0, 1.0));
        }
        CHECK(angle == Approx(2.0 * M_PI).epsilon(1e-6));
        const Vec3 through = fem.nodes_mm[fem.first_node[s] + 1] - fem.nodes_mm[fem.first_node[s]];
        CHECK(through.norm() == Approx(1.5));
        CHECK(through.normalized().dot(c.shell.normals[c.graph.samples[s]].cast<double>()) ==
              Approx(1.0).epsilon(1e-6));
    }
    std::size_t folded = 0;
    REQUIRE(fem.beams.size() == c.graph.edges.size());
    for (EdgeIndex e = 0; e < fem.beams.size(); ++e) {
        const Beam& beam = fem.beams[e];
        const auto belongs = [&](NodeIndex n, SampleIndex s) {
            return n >= fem.first_node[s] + 2 && n < fem.first_node[s + 1];
        };
        for (const int n : {0, 3, 7, 4}) REQUIRE(belongs(beam.nodes[static_cast<std::size_t>(n)], c.graph.edges[e].a));
        for (const int n : {1, 2, 6, 5}) REQUIRE(belongs(beam.nodes[static_cast<std::size_t>(n)], c.graph.edges[e].b));
        REQUIRE(std::set<NodeIndex>(beam.nodes.begin(), beam.nodes.end()).size() == 8);
        REQUIRE(beam.folds == !(least_jacobian(corners_of<8>(fem, beam.nodes)) > 0.0));
        folded += beam.folds ? 1u : 0u;
    }
    CHECK(folded == fem.folded_beams);
    // Beams over sharp or strongly curved places fold; those are few.
    CHECK(folded * 10 < fem.beams.size());
}

TEST_CASE("beam-wedge mesh: fans close at samples without neighbours", "[fem]") {
    Case c = blob_case(make_icosphere(20.0, 4), 40, 1, 60);
    c.graph.edges.clear();
    c.graph.path.clear();
    c.graph.first_path.assign(1, 0);
    const BeamWedgeMesh fem =
        build_beam_wedge_mesh(c.shell, c.graph, std::vector<float>(c.graph.samples.size(), 3.0f), {});
    CHECK(fem.wedges.size() == 3 * c.graph.samples.size());
    for (const Wedge& wedge : fem.wedges) CHECK(least_jacobian(corners_of<6>(fem, wedge.nodes)) > 0.0);
}

TEST_CASE("beam widths: a sheet is shared among its edges, a strip is as wide as it is", "[fem][property]") {
    // Borders between regions and the edges across them make kites that fill a sheet: the sum of w L / 2 is its area.
    // Widths hold 1.5 times the border; voxel borders and the rim leave 20 %.
    for (const double tilt : {0.0, 0.5}) {
        const TriangleMesh sheet = testing::rotated(make_square(60.0, 4), Vec3(1, 0.3, 0.2), tilt);
        const Case c = make_case(sheet, 60, nullptr, 150);
        const BeamWidths widths = beam_widths(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), 3.0);
        double kites = 0.0;
        for (EdgeIndex e = 0; e < c.graph.edges.size(); ++e) {
            const Vec3 way = c.shell.points_mm[c.graph.samples[c.graph.edges[e].b]] -
                             c.shell.points_mm[c.graph.samples[c.graph.edges[e].a]];
            kites += 0.5 * way.norm() * widths.along_edge_mm[e] / 1.5;
        }
        CHECK(kites == Approx(3600.0).epsilon(0.2));
        // Random samples of a sheet make a few edges over borders of next to nothing, and only those are slivers.
        const auto slivers = std::ranges::count(widths.is_sliver, std::uint8_t{1});
        CHECK(slivers > 0);
        CHECK(static_cast<double>(slivers) < 0.25 * static_cast<double>(c.graph.edges.size()));
        for (EdgeIndex e = 0; e < c.graph.edges.size(); ++e) {
            const double length_mm = static_cast<double>(c.graph.edges[e].length_voxels) * c.shell.grid.voxel_mm;
            CHECK((widths.is_sliver[e] != 0) == (widths.along_edge_mm[e] < 0.25 * length_mm));
        }
    }
    // A strip of 4 mm with a sample every 8: every edge is as wide as the strip.
    const SurfaceVoxels shell = voxelize(make_square(60.0, 4), {.resolution = 60});
    SolidStates strip(shell.size());
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        strip[v] = shell.coords[v][1] >= 28 && shell.coords[v][1] < 32 ? SolidState::kSolid : SolidState::kEmpty;
    const Case c = make_case(make_square(60.0, 4), 60, &strip, 5);
    const BeamWidths widths = beam_widths(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), 3.0);
    for (EdgeIndex e = 0; e < c.graph.edges.size(); ++e) {
        CHECK(widths.along_edge_mm[e] >= 3.0);
        CHECK(widths.along_edge_mm[e] <= 4.01);
        CHECK(widths.is_sliver[e] == 0);
    }
}

TEST_CASE("sample loads: add up to the weight of the pattern and the forces on patches", "[fem][property]") {
    const auto seed = GENERATE(range(1u, 5u));
    const Case c = blob_case(make_icosphere(20.0, 4), 40, seed, 80);
    const Material pla = material_by_name("PLA");
    double area = 0.0;
    for (VoxelIndex v = 0; v < c.shell.size(); ++v)
        if (c.solid[v] == SolidState::kSolid) area += static_cast<double>(c.shell.area_mm2[v]);
    const Vec3 weight(0, 0, -area * 2.0 * pla.density_kg_m3 * 9.81e-9);

    LoadCase load_case = gravity_case(c.shell, Vec3(0, 0, -3));
    const auto total = [](const SampleLoads& loads) {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& f : loads.force_n) sum += f;
        return sum;
    };
    const SampleLoads by_mass = loads_on_samples(c.shell, c.solid, c.graph, load_case, pla, 2.0);
    CHECK((total(by_mass) - weight).norm() < 1e-9 * weight.norm());
    load_case.constant_per_sample = true;
    const SampleLoads constant = loads_on_samples(c.shell, c.solid, c.graph, load_case, pla, 2.0);
    CHECK((total(constant) - weight).norm() < 1e-9 * weight.norm());
    for (const Vec3& f : constant.force_n) CHECK((f - constant.force_n[0]).norm() == 0.0);

    LoadCase patch;
    patch.loads.push_back({{1, 5, 9, static_cast<VoxelIndex>(c.shell.size() - 1)}, Vec3(1, 2, 3), 0.0});
    CHECK((total(loads_on_samples(c.shell, c.solid, c.graph, patch, pla, 2.0)) - Vec3(1, 2, 3)).norm() < 1e-12);

    // A pressure on all of a closed surface adds up to nothing, on the upper half to pressure times the disc.
    LoadCase pressure;
    pressure.loads.emplace_back();
    pressure.loads[0].pressure_mpa = 0.1;
    for (VoxelIndex v = 0; v < c.shell.size(); ++v) pressure.loads[0].voxels.push_back(v);
    const double sphere = 4.0 * M_PI * 400.0 * 0.1;
    CHECK(total(loads_on_samples(c.shell, c.solid, c.graph, pressure, pla, 2.0)).norm() < 0.01 * sphere);
    std::erase_if(pressure.loads[0].voxels, [&](VoxelIndex v) { return c.shell.points_mm[v][2] < 0.0; });
    const Vec3 down = total(loads_on_samples(c.shell, c.solid, c.graph, pressure, pla, 2.0));
    CHECK(down[2] == Approx(-M_PI * 400.0 * 0.1).epsilon(0.08));
}

TEST_CASE("sample loads: every piece of the abstract graph is held somewhere", "[fem][property]") {
    const Case c = blob_case(make_linked_tori(20.0, 6.0), 48, 2, 90);
    const Material pla = material_by_name("PLA");
    for (const double share : {0.1, 0.001}) {
        LoadCase load_case = gravity_case(c.shell, -Vec3::UnitZ(), share);
        for (const bool none : {false, true}) {
            if (none) load_case.fixed.clear();
            const SampleLoads loads = loads_on_samples(c.shell, c.solid, c.graph, load_case, pla, 2.0);
            std::vector<int> held(2, 0);
            for (SampleIndex s = 0; s < loads.fixed.size(); ++s)
                held[c.shell.components[c.graph.samples[s]]] += loads.fixed[s];
            CHECK(held[0] > 0);
            CHECK(held[1] > 0);
            CHECK(held[0] + held[1] < static_cast<int>(loads.fixed.size()) / 2);
        }
    }
}

TEST_CASE("force profile: gravity holds the lowest tenth of each component, handling presses from both sides",
          "[fem]") {
    const SurfaceVoxels shell = voxelize(make_linked_tori(20.0, 6.0), {.resolution = 48});
    const LoadCase gravity = gravity_case(shell, Vec3(0, 0, -2));
    CHECK(gravity.acceleration_g == Vec3(0, 0, -1));
    std::vector<double> low(2, 1e9), high(2, -1e9);
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        low[shell.components[v]] = std::min(low[shell.components[v]], shell.points_mm[v][2]);
        high[shell.components[v]] = std::max(high[shell.components[v]], shell.points_mm[v][2]);
    }
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        const std::uint32_t c = shell.components[v];
        const bool fixed = std::ranges::binary_search(gravity.fixed, v);
        CHECK(fixed == (shell.points_mm[v][2] <= low[c] + 0.1 * (high[c] - low[c])));
    }
    const std::vector<LoadCase> handling = handling_cases(shell, 10.0);
    REQUIRE(handling.size() == 5);
    for (const LoadCase& load_case : handling) {
        Vec3 sum = Vec3::Zero();
        double pushed = 0.0;
        for (const PatchLoad& patch : load_case.loads) {
            CHECK(patch.force_n.norm() == Approx(10.0));
            CHECK_FALSE(patch.voxels.empty());
            sum += patch.force_n;
            pushed += patch.force_n.norm();
        }
        const bool balanced = load_case.name == "pinch along x" || load_case.name == "pinch along y";
        CHECK(pushed == Approx(balanced ? 40.0 : 20.0));
        CHECK(sum.norm() == Approx(balanced ? 0.0 : 20.0).margin(1e-12));
        CHECK(load_case.fixed == gravity.fixed);
    }
    CHECK_THROWS_AS(gravity_case(shell, Vec3::Zero()), InvalidSetting);
    CHECK_THROWS_AS(gravity_case(shell, -Vec3::UnitZ(), 0.0), InvalidSetting);
    CHECK_THROWS_AS(handling_cases(shell, 10.0, 1.5), InvalidSetting);
}

TEST_CASE("beam model: a strip in tension feels force over area", "[fem]") {
    // A strip 60 x 10, held at one end, pulled at the other with 30 N in its plane; wall 2 mm. The mean of sigma over a
    // section is 30 / (10 * 2) = 1.5 MPa. The model is a net of beams whose
    // worst Gauss points also bend: the median over the edges along the strip lies between 0.8 and 1.6 times that.
    const SurfaceVoxels shell = voxelize(make_square(60.0, 8), {.resolution = 60});
    SolidStates strip(shell.size());
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        strip[v] =
            shell.points_mm[v][1] > 25.0 && shell.points_mm[v][1] < 35.0 ? SolidState::kSolid : SolidState::kEmpty;
    const Case c = make_case(make_square(60.0, 8), 60, &strip, 60);
    LoadCase pull;
    PatchLoad patch;
    patch.force_n = Vec3(30, 0, 0);
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        if (strip[v] == SolidState::kEmpty) continue;
        if (shell.points_mm[v][0] < 3.0) pull.fixed.push_back(v);
        if (shell.points_mm[v][0] > 57.0) patch.voxels.push_back(v);
    }
    pull.loads.push_back(patch);
    ForceProfile profile{{pull}};
    BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), profile, material_by_name("PLA"),
                    {});
    const std::vector<double> scores = model.edge_scores_pa(states_of(c.graph));
    std::vector<double> along;
    for (EdgeIndex e = 0; e < scores.size(); ++e) {
        const Vec3 way = c.shell.points_mm[c.graph.samples[c.graph.edges[e].b]] -
                         c.shell.points_mm[c.graph.samples[c.graph.edges[e].a]];
        const double middle = 0.5 * (c.shell.points_mm[c.graph.samples[c.graph.edges[e].b]][0] +
                                     c.shell.points_mm[c.graph.samples[c.graph.edges[e].a]][0]);
        if (c.graph.edges[e].state == EdgeState::kSolid && std::abs(way[0]) > 0.9 * way.norm() && middle > 10 &&
            middle < 50)
            along.push_back(scores[e]);
    }
    REQUIRE(along.size() >= 5);
    std::ranges::sort(along);
}

/// A closed plate 60 x 20 x 3 of 0.5 mm voxels with a strip along the middle of its top and its bottom, not over the
/// rims.
Case two_strips() {
    const TriangleMesh plate = make_box(Vec3::Zero(), Vec3(60, 20, 3));
    const SurfaceVoxels shell = voxelize(plate, {.resolution = 120});
    SolidStates strips(shell.size(), SolidState::kEmpty);
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        const Vec3& p = shell.points_mm[v];
        const bool flat = std::abs(shell.normals[v][2]) > 0.9F;
        if (flat && p[0] > 3.0 && p[0] < 57.0 && p[1] > 4.0 && p[1] < 16.0) strips[v] = SolidState::kSolid;
    }
    return make_case(plate, 120, &strips, 200);
}

TEST_CASE("facing sheets: those whose walls meet inside, and no others", "[fem][property]") {
    const Case c = two_strips();
    const std::vector<VoxelIndex> meeting = facing_voxels(c.shell, 2.0);
    const std::vector<VoxelIndex> apart = facing_voxels(c.shell, 1.0);
    REQUIRE(meeting.size() == c.shell.size());
    double strip_mm2 = 0.0;
    for (VoxelIndex v = 0; v < c.shell.size(); ++v) {
        if (c.solid[v] != SolidState::kSolid) continue;
        strip_mm2 += 0.5 * static_cast<double>(c.shell.area_mm2[v]);
        CHECK(apart[v] == kNoVoxel);
        REQUIRE(meeting[v] != kNoVoxel);
        const Vec3 way = c.shell.points_mm[meeting[v]] - c.shell.points_mm[v];
        CHECK(std::abs(std::abs(way[2]) - 3.0) < 1e-9);
        CHECK(way.head<2>().norm() <= c.shell.grid.voxel_mm);
    }
    CHECK(strip_mm2 == Approx(54.0 * 12.0).epsilon(0.1));
    double tied_mm2 = 0.0;
    for (const SheetTie& tie : sheet_ties(c.shell, c.solid, c.graph, meeting)) {
        CHECK(tie.a < tie.b);
        CHECK(std::abs(c.shell.normals[c.graph.samples[tie.a]][2] + c.shell.normals[c.graph.samples[tie.b]][2]) < 0.1F);
        tied_mm2 += tie.area_mm2;
    }
    CHECK(tied_mm2 > 0.8 * strip_mm2);
    CHECK(tied_mm2 <= strip_mm2 * (1.0 + 1e-9));
    CHECK(sheet_ties(c.shell, c.solid, c.graph, {}).empty());
    const std::vector<VoxelIndex> outside = facing_voxels(c.shell, 0.0);
    CHECK(std::ranges::all_of(outside, [](VoxelIndex v) { return v == kNoVoxel; }));
}

/// A wedge along y, whose edge at the origin has this angle inside.
TriangleMesh make_wedge(double angle_rad) {
    const Vec3 up(40.0 * std::cos(angle_rad), 0, 40.0 * std::sin(angle_rad)), along(40, 0, 0), far(0, 20, 0);
    return {{Vec3::Zero(), along, up, far, along + far, up + far},
            {{0, 1, 2}, {3, 5, 4}, {0, 3, 4}, {0, 4, 1}, {1, 4, 5}, {1, 5, 2}, {2, 5, 3}, {2, 3, 0}}};
}

TEST_CASE("facing sheets: walls that meet around an edge count where it is sharp", "[fem]") {
    const auto meeting_at_edge = [](double degrees) {
        const SurfaceVoxels shell = voxelize(make_wedge(degrees * std::numbers::pi / 180.0), {.resolution = 60});
        const std::vector<VoxelIndex> meeting = facing_voxels(shell, 6.0);
        std::size_t count = 0;
        for (VoxelIndex v = 0; v < shell.size(); ++v) {
            const Vec3& p = shell.points_mm[v];
            // Away from the ends, and from voxels that stand for both faces.
            const double away = std::hypot(p[0], p[2]);
            if (away > 1.0 && away < 5.0 && p[1] > 4.0 && p[1] < 16.0 && meeting[v] != kNoVoxel) ++count;
        }
        return count;
    };
    CHECK(meeting_at_edge(80.0) == 0);  // normals 100 degrees apart
    CHECK(meeting_at_edge(40.0) > 100);
}

TEST_CASE("facing sheets: a few voxels are no tie", "[fem]") {
    const TriangleMesh plate = make_box(Vec3::Zero(), Vec3(60, 30, 3));
    const Case c = make_case(plate, 60, nullptr, 60);
    const double voxel_mm2 = c.shell.grid.voxel_mm * c.shell.grid.voxel_mm;
    double least_mm2 = 1e9;
    for (const SheetTie& tie : sheet_ties(c.shell, c.solid, c.graph, facing_voxels(c.shell, 2.0)))
        least_mm2 = std::min(least_mm2, tie.area_mm2);
    CHECK(least_mm2 >= 4.0 * voxel_mm2);
    CHECK(least_mm2 < 8.0 * voxel_mm2);
}

/// Largest score of the solid edges on the top and on the bottom of the plate, held at one end, pressed down on the top
/// at the other.
std::pair<double, double> scores_above_and_below(const Case& c, double inner_wall_mm) {
    LoadCase press;
    PatchLoad patch;
    patch.force_n = Vec3(0, 0, -1);
    for (VoxelIndex v = 0; v < c.shell.size(); ++v) {
        if (c.solid[v] != SolidState::kSolid) continue;
        if (c.shell.points_mm[v][0] < 9.0) press.fixed.push_back(v);
        if (c.shell.points_mm[v][0] > 52.0 && c.shell.normals[v][2] > 0.0F) patch.voxels.push_back(v);
    }
    press.loads.push_back(patch);
    BeamModelSettings settings;
    settings.soft_factor = 1e-7;  // what is empty carries nothing over the rims
    settings.facing = facing_voxels(c.shell, inner_wall_mm);
    const ForceProfile profile{{press}};
    BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), profile, material_by_name("PLA"),
                    settings);
    const std::vector<double> scores = model.edge_scores_pa(states_of(c.graph));
    std::pair<double, double> highest{0.0, 0.0};
    for (EdgeIndex e = 0; e < scores.size(); ++e) {
        if (c.graph.edges[e].state != EdgeState::kSolid) continue;
        const bool above = c.shell.normals[c.graph.samples[c.graph.edges[e].a]][2] > 0.0F;
        double& side = above ? highest.first : highest.second;
        side = std::max(side, scores[e]);
    }
    return highest;
}

TEST_CASE("beam model: sheets whose walls have grown together bear a load together", "[fem]") {
    const Case c = two_strips();
    const auto [alone, unloaded] = scores_above_and_below(c, 1.0);
    const auto [above, below] = scores_above_and_below(c, 2.0);
    CAPTURE(alone, unloaded, above, below);
    REQUIRE(alone > 0.0);
    CHECK(unloaded < 0.1 * alone);
    // A thicker body bends less; its two sides are stretched and pressed about alike.
    CHECK(above < 0.6 * alone);
    CHECK(above > 0.05 * alone);
    CHECK(below > 0.5 * above);
    CHECK(below < 2.0 * above);
}

TEST_CASE("beam model: scores follow the load, and self-weight does not know Young's modulus", "[fem][property]") {
    const Case c = make_case(make_cylinder(10.0, 40.0, 48, 12), 48, nullptr, 120);
    const std::vector<EdgeState> states = states_of(c.graph);
    const Material pla = material_by_name("PLA");
    const auto scores = [&](double g, const Material& material) {
        LoadCase load_case = gravity_case(c.shell, -Vec3::UnitZ());
        load_case.acceleration_g *= g;
        BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), ForceProfile{{load_case}},
                        material, {});
        return model.edge_scores_pa(states);
    };
    const std::vector<double> once = scores(1.0, pla);
    const std::vector<double> thrice = scores(3.0, pla);
    Material stiff = pla;
    stiff.youngs_modulus_mpa *= 7.0;
    const std::vector<double> stiffer = scores(1.0, stiff);
    for (std::size_t e = 0; e < once.size(); ++e) {
        CHECK(thrice[e] == Approx(3.0 * once[e]).epsilon(1e-6).margin(1e-6));
        CHECK(stiffer[e] == Approx(once[e]).epsilon(1e-6).margin(1e-6));
    }
    // The weight of everything above goes through the wall just above the base:
    // rho g h with 90 % of 40 mm and the cap, whose area is a quarter of diameter times height times pi.
    const double bottom = 1240.0 * 9.81 * (0.036 + 0.005);
    double worst = 0.0;
    for (const double s : once) worst = std::max(worst, s);
    CHECK(worst > 0.5 * bottom);
    CHECK(worst < 6.0 * bottom);
}

TEST_CASE("beam model: score is the maximum over load cases, however they are grouped", "[fem]") {
    const Case c = blob_case(make_icosphere(20.0, 4), 40, 3, 80);
    const std::vector<EdgeState> states = states_of(c.graph);
    const Material pla = material_by_name("PLA");
    ForceProfile all{handling_cases(c.shell)};
    LoadCase other = gravity_case(c.shell, Vec3::UnitX(), 0.3);  // supports of its own
    all.cases.push_back(other);
    std::vector<double> expected(c.graph.edges.size(), 0.0);
    for (const LoadCase& load_case : all.cases) {
        BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), ForceProfile{{load_case}}, pla,
                        {});
        const std::vector<double> scores = model.edge_scores_pa(states);
        for (std::size_t e = 0; e < scores.size(); ++e) expected[e] = std::max(expected[e], scores[e]);
    }
    BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), all, pla, {});
    const std::vector<double> scores = model.edge_scores_pa(states);
    for (std::size_t e = 0; e < scores.size(); ++e) CHECK(scores[e] == Approx(expected[e]).epsilon(1e-6));
}

TEST_CASE("beam model: solving again gives the same, and stiffer edges relieve the soft ones", "[fem]") {
    const Case c = blob_case(make_icosphere(20.0, 4), 40, 4, 80);
    std::vector<EdgeState> states = states_of(c.graph);
    BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid),
                    ForceProfile{handling_cases(c.shell)}, material_by_name("PLA"), {});
    const std::vector<double> before = model.edge_scores_pa(states);
    CHECK(model.edge_scores_pa(states) == before);
    const auto worst_empty = [&](const std::vector<double>& scores) {
        double worst = 0.0;
        for (std::size_t e = 0; e < scores.size(); ++e)
            if (c.graph.edges[e].state == EdgeState::kEmpty) worst = std::max(worst, scores[e]);
        return worst;
    };
    std::ranges::fill(states, EdgeState::kSolid);
    CHECK(worst_empty(model.edge_scores_pa(states)) < 0.2 * worst_empty(before));
}

TEST_CASE("beam model: the same bits on any number of threads", "[fem][determinism]") {
    const Case c = blob_case(make_icosphere(20.0, 4), 40, 5, 80);
    const std::vector<EdgeState> states = states_of(c.graph);
    std::vector<double> reference;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid),
                        ForceProfile{handling_cases(c.shell)}, material_by_name("PLA"), {});
        const std::vector<double> scores = model.edge_scores_pa(states);
        if (threads == 1) reference = scores;
        CHECK(scores == reference);
    }
}

TEST_CASE("beam model: stops when asked", "[fem]") {
    const Case c = blob_case(make_icosphere(20.0, 4), 32, 5, 40);
    std::stop_source source;
    const RunControl run(nullptr, source.get_token());
    const ForceProfile profile{handling_cases(c.shell)};
    BeamModel model(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), profile, material_by_name("PLA"), {},
                    run);
    source.request_stop();
    CHECK_THROWS_AS(model.edge_scores_pa(states_of(c.graph), run), Cancelled);
    CHECK_THROWS_AS(BeamModel(c.shell, c.solid, c.graph, beam_half_widths(c.shell, c.solid), profile,
                              material_by_name("PLA"), {}, run),
                    Cancelled);
}

}  // namespace
}  // namespace fretwork
