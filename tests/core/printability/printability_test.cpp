#include "core/printability/printability.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/mesh_report.h"
#include "core/printability/print_faults.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

void append(TriangleMesh& mesh, const TriangleMesh& more) {
    const auto first = static_cast<std::uint32_t>(mesh.positions_mm.size());
    mesh.positions_mm.insert(mesh.positions_mm.end(), more.positions_mm.begin(), more.positions_mm.end());
    for (const Triangle& t : more.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

TriangleMesh blocks(const std::vector<std::pair<Vec3, Vec3>>& boxes) {
    TriangleMesh mesh;
    for (const auto& [low, high] : boxes) append(mesh, make_box(low, high, {2, 2, 2}));
    return mesh;
}

TEST_CASE("printability: a block on the bed has nothing to complain of", "[printability]") {
    const PrintabilityReport report = printability(blocks({{Vec3(3, 4, 5), Vec3(13, 24, 15)}}), {});
    CHECK(report.layers == 50);
    CHECK(report.empty_layers == 0);
    CHECK(report.first_layer_contact_mm2 == Approx(200.0));
    CHECK(report.material_mm3 == Approx(2000.0));
    CHECK(report.islands == 0);
    CHECK(report.overhang_area_mm2 == 0.0);
    CHECK(report.longest_bridge.size_mm == 0.0);
    CHECK(report.longest_cantilever.size_mm == 0.0);
    CHECK_FALSE(report.least_solid);
    CHECK_FALSE(report.least_hole);
    CHECK(report.loose_parts == 0);
    CHECK(report.closed_cavities == 0);
}

TEST_CASE("printability: a table bridges between its legs and its rim hangs over", "[printability]") {
    // Two walls 20 mm apart carry a top that hangs 5 mm over on one side.
    const PrintabilityReport report = printability(blocks({{Vec3(0, 0, 0), Vec3(4, 10, 8.1)},
                                                           {Vec3(24, 0, 0), Vec3(28, 10, 8.1)},
                                                           {Vec3(0, 0, 8), Vec3(33, 10, 10)}}),
                                                   {});
    CHECK(report.longest_bridge.size_mm == Approx(20.0).epsilon(0.05));
    CHECK(report.longest_bridge.at_mm[0] == Approx(14.0).margin(1.0));
    CHECK(report.longest_bridge.at_mm[2] == Approx(8.1).margin(0.2));
    CHECK(report.longest_cantilever.size_mm == Approx(5.0).epsilon(0.05));
    CHECK(report.longest_cantilever.at_mm[0] == Approx(33.0).margin(0.3));
    // All that hangs, but the reach that 45 degrees allow on each of the three sides.
    CHECK(report.overhang_area_mm2 == Approx(10.0 * (20.0 - 0.4 + 5.0 - 0.2)));
    CHECK(report.islands == 0);
}

TEST_CASE("printability: a roof is a bridge, however it is held", "[printability]") {
    // A box with a hollow of 12 x 18 that opens to below.
    const PrintabilityReport report = printability(blocks({{Vec3(0, 0, 0), Vec3(3, 24, 6.1)},
                                                           {Vec3(15, 0, 0), Vec3(18, 24, 6.1)},
                                                           {Vec3(0, 0, 0), Vec3(18, 3, 6.1)},
                                                           {Vec3(0, 21, 0), Vec3(18, 24, 6.1)},
                                                           {Vec3(0, 0, 6), Vec3(18, 24, 8)}}),
                                                   {});
    CHECK(report.longest_bridge.size_mm == Approx(12.0).epsilon(0.05));
    CHECK(report.longest_cantilever.size_mm == 0.0);
}

TEST_CASE("printability: islands are parts that begin in the air", "[printability]") {
    const PrintabilityReport report = printability(
        blocks({{Vec3(0, 0, 0), Vec3(5, 5, 10)}, {Vec3(10, 0, 4), Vec3(13, 4, 10)}, {Vec3(20, 0, 6), Vec3(22, 2, 10)}}),
        {});
    CHECK(report.islands == 2);
    REQUIRE(report.island_places.size() == 2);
    CHECK(report.island_places[0].size_mm == Approx(std::sqrt(12.0)));
    CHECK((report.island_places[0].at_mm - Vec3(11.5, 2, 4.1)).norm() < 0.11);
    CHECK(report.island_places[1].size_mm == Approx(2.0));
    CHECK(report.islands_per_layer[20] == 1);
    CHECK(report.islands_per_layer[30] == 1);
    CHECK(report.loose_parts == 2);
    const TriangleMesh pair = blocks({{Vec3(0, 0, 0), Vec3(5, 5, 5)}, {Vec3(9, 0, 0), Vec3(13, 4, 5)}});
    CHECK(printability(pair, {}).loose_parts == 1);
    CHECK(printability(pair, {.bodies = 2}).loose_parts == 0);
}

TEST_CASE("printability: overhang depends on the slope and on what is allowed", "[printability]") {
    // A cone upside down: its side leans 30 degrees from the vertical.
    TriangleMesh cone = make_cylinder(10.0, 10.0, 96, 20);
    for (Vec3& p : cone.positions_mm) {
        const double radius = 2.0 + p[2] * std::tan(std::numbers::pi / 6);
        p[0] *= radius / 10.0, p[1] *= radius / 10.0;
    }
    PrintabilitySettings settings;
    CHECK(printability(cone, settings).overhang_area_mm2 == 0.0);
    settings.overhang_deg = 25.0;
    const double top = 2.0 + 9.9 * std::tan(std::numbers::pi / 6), bottom = 2.0 + 0.1 * std::tan(std::numbers::pi / 6);
    const double all = std::numbers::pi * (top * top - bottom * bottom);
    const double share = 1.0 - std::tan(25.0 * std::numbers::pi / 180) / std::tan(std::numbers::pi / 6);
    CHECK(printability(cone, settings).overhang_area_mm2 == Approx(share * all).epsilon(0.02));
}

TEST_CASE("printability: strands and gaps are as wide as the way across them", "[printability]") {
    // Two blocks with a strand of 0.5 mm between them, and a slot of 0.3 mm behind the second.
    const auto with_strand = [](double strand, double slot) {
        return blocks({{Vec3(0, 0, 0), Vec3(10, 10, 2)},
                       {Vec3(9, 5, 0), Vec3(21, 5 + strand, 2)},
                       {Vec3(20, 0, 0), Vec3(30, 10, 2)},
                       {Vec3(30 + slot, 0, 0), Vec3(40, 10, 2)}});
    };
    const PrintabilityReport thin = printability(with_strand(0.5, 0.3), {});
    REQUIRE(thin.least_solid);
    CHECK(thin.least_solid->size_mm == Approx(0.5).margin(0.01));
    CHECK(thin.least_solid->at_mm[0] == Approx(15.0).margin(6.0));
    REQUIRE(thin.least_hole);
    CHECK(thin.least_hole->size_mm == Approx(0.3).margin(0.01));
    CHECK(thin.least_hole->at_mm[0] == Approx(30.15).margin(0.16));
    // Both sides of the slot, of all the surface there is.
    const double area = report_mesh(with_strand(0.5, 0.3)).area_mm2;
    CHECK(thin.narrow_share == Approx(2 * 10 * 2 / area).epsilon(0.1));
    const PrintabilityReport wide = printability(with_strand(0.9, 0.9), {});
    CHECK_FALSE(wide.least_solid);
    CHECK_FALSE(wide.least_hole);
    CHECK(wide.thin_share == 0.0);
    CHECK(wide.narrow_share == 0.0);
}

TEST_CASE("printability: round and square rods have their own width, whatever way they lie", "[printability]") {
    TriangleMesh rod = make_cylinder(0.35, 20.0, 48, 30);
    const auto tilt = GENERATE(0.0, 30.0, 90.0);
    const double c = std::cos(tilt * std::numbers::pi / 180), s = std::sin(tilt * std::numbers::pi / 180);
    TriangleMesh bar = make_box(Vec3::Zero(), Vec3(0.7, 0.7, 20), {1, 1, 12});
    for (TriangleMesh* mesh : {&rod, &bar}) {
        for (Vec3& p : mesh->positions_mm) p = Vec3(c * p[0] + s * p[2], p[1], -s * p[0] + c * p[2]);
        const PrintabilityReport report = printability(*mesh, {});
        REQUIRE(report.least_solid);
        CHECK(report.least_solid->size_mm == Approx(0.7).margin(0.01));
        CHECK(report.thin_share > 0.9 * 0.7);
    }
}

TEST_CASE("printability: edges and corners are not thin", "[printability]") {
    CHECK_FALSE(printability(make_box(Vec3::Zero(), Vec3(5, 5, 5), {3, 3, 3}), {}).least_solid);
    CHECK_FALSE(printability(make_sphere(4.0, 48, 96), {}).least_solid);
    // Nor is a prism of three sides, whose walls face each other by 60 degrees only.
    CHECK_FALSE(printability(make_cylinder(6.0, 8.0, 3), {}).least_solid);
    CHECK(printability(make_cylinder(6.0, 8.0, 3), {}).thin_share == 0.0);
    // A right-angled groove is no gap.
    CHECK_FALSE(printability(blocks({{Vec3(0, 0, 0), Vec3(9, 9, 3)}, {Vec3(0, 0, 0), Vec3(3, 9, 9)}}), {}).least_hole);
}

TEST_CASE("printability: a hollow without a way out is found", "[printability]") {
    const PrintabilityReport report = printability(make_nested_spheres(10.0, 6.0), {});
    CHECK(report.closed_cavities == 1);
    CHECK(report.loose_parts == 0);
    CHECK(report.material_mm3 == Approx(report_mesh(make_nested_spheres(10.0, 6.0)).volume_mm3));
}

TEST_CASE("printability: layers add up to the volume, turned and on any number of threads",
          "[printability][property]") {
    TriangleMesh mesh = make_torus(14.0, 4.0, 64, 32);
    for (Vec3& p : mesh.positions_mm) p = Vec3(p[1], p[2], p[0]);  // stands on its rim
    PrintabilitySettings settings;
    settings.layer_height_mm = 0.1;
    const PrintabilityReport report = printability(mesh, settings);
    CHECK(report.layers == 360);
    CHECK(report.empty_layers == 0);
    // The hole closes over in an arch: its crown is a bridge, and nothing begins in the air.
    CHECK(report.islands == 0);
    CHECK(report.longest_bridge.size_mm > 1.0);
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        const PrintabilityReport again = printability(mesh, settings);
        CHECK(again.overhang_area_mm2 == report.overhang_area_mm2);
        CHECK(again.longest_bridge.size_mm == report.longest_bridge.size_mm);
        CHECK(again.longest_bridge.at_mm == report.longest_bridge.at_mm);
    }
}

TEST_CASE("printability: each fault is told with its numbers, and nothing else is a fault", "[printability]") {
    PrintabilityReport report;
    report.layers = 10;
    report.first_layer_contact_mm2 = 5.0;
    report.islands = 3;
    report.island_places = {{Vec3(1, 2, 3), 1.0}};
    report.closed_cavities = 1;
    report.least_solid = PrintPlace{Vec3(4, 5, 6), 0.45};
    CHECK(print_faults(report, 0.4).empty());
    const std::vector<std::string> cautions = print_cautions(report);
    REQUIRE(cautions.size() == 2);
    CHECK_THAT(cautions[0], Catch::Contains("3 places") && Catch::Contains("(1.0, 2.0, 3.0)"));
    const auto only = [&](const std::string& says) {
        const std::vector<std::string> faults = print_faults(report, 0.4);
        REQUIRE(faults.size() == 1);
        CHECK_THAT(faults[0], Catch::Contains(says));
    };
    report.least_solid->size_mm = 0.35;
    only("0.35 mm wide at (4.0, 5.0, 6.0) mm");
    report.least_solid.reset();
    report.first_layer_contact_mm2 = 0.5;
    only("only 0.5 mm2");
    report.first_layer_contact_mm2 = 5.0;
    report.empty_layers = 2;
    only("2 of 10 layers");
    report.empty_layers = 0;
    report.loose_parts = 2;
    only("2 loose parts");
}

TEST_CASE("printability: heights without material between others are empty layers", "[printability]") {
    const PrintabilityReport report =
        printability(blocks({{Vec3(0, 0, 0), Vec3(5, 5, 2)}, {Vec3(0, 0, 3), Vec3(5, 5, 4)}}), {});
    CHECK(report.layers == 20);
    CHECK(report.empty_layers == 5);
}

TEST_CASE("printability: settings out of range are refused", "[printability][errors]") {
    const TriangleMesh box = make_box(Vec3::Zero(), Vec3(5, 5, 5));
    CHECK_THROWS_WITH(printability(box, {.layer_height_mm = 0.0}), Catch::Contains("layer_height_mm is 0"));
    CHECK_THROWS_AS(printability(box, {.overhang_deg = 90.0}), InvalidSetting);
    CHECK_THROWS_AS(printability(box, {.min_feature_mm = -1.0}), InvalidSetting);
    CHECK_THROWS_AS(printability(make_box(Vec3::Zero(), Vec3(5, 5, 2000)), {.layer_height_mm = 0.01}), InvalidInput);
    CHECK_THROWS_AS(printability({}, {}), InvalidInput);
}

}  // namespace
}  // namespace fretwork
