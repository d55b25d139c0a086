// Promises 1 to 4 on what comes out of the whole flow, over models, patterns and seeds.
#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>

#include "core/base/float_rounding.h"
#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/mesh/closest_point.h"
#include "core/mesh/mesh_report.h"
#include "properties/carve_cases.h"
#include "support/make_meshes.h"
#include "support/width_oracle.h"

namespace fretwork::testing {
namespace {

/// Coordinates as a file with single precision keeps them.
TriangleMesh as_written(TriangleMesh mesh) {
    for (Vec3& p : mesh.positions_mm) p = rounded_to_float(p);
    return mesh;
}

void check_valid(const TriangleMesh& mesh) {
    const MeshReport report = report_mesh(mesh, CountSelfIntersections::kYes);
    CHECK(report.closed_manifold());
    CHECK(report.non_manifold_vertices == 0);
    CHECK(report.degenerate_triangles == 0);
    CHECK(report.self_intersections == 0);
    CHECK(report.volume_mm3 > 0.0);
}

/// Wall thickness away from the rim: no point of the wall is deeper below the surface than the wall is thick, and
/// none lies outside by more than rounding and simplification allow.
void check_wall(const CarveResult& result, const PropertyModel& model) {
    const SurfaceTree surface(result.surface);
    const double voxel = result.report.shell.voxel_mm;
    const double wall = std::min((model.open ? 0.5 : 1.0) * result.report.shell.thickness_mm, model.inradius_mm);
    double deepest = 0.0;
    double highest = 0.0;
    for (const Vec3& p : result.carved.mesh.positions_mm) {
        const double d = model.open ? surface.closest(p).distance_mm : -surface.signed_distance_mm(p);
        deepest = std::max(deepest, d);
        highest = std::min(highest, d);
    }
    CHECK(deepest <= wall + 0.35 * voxel);
    CHECK(deepest >= wall - 0.35 * voxel);
    CHECK(highest >= -0.35 * voxel);
}

/// Promises 1, 3 and 4.
void check_carved(const PropertyModel& model, const std::string& pattern, std::uint64_t seed) {
    CAPTURE(model.name, pattern, seed);
    const CarveResult result = carve_model(model, pattern, seed);
    CHECK(body_count(result.carved.mesh) == model.parts);
    check_valid(result.carved.mesh);
    check_valid(as_written(result.carved.mesh));
    check_wall(result, model);
    REQUIRE(result.carved.triangle_colors.size() == result.carved.mesh.triangles.size());
}

TEST_CASE("carve: one piece for each part, a valid mesh, the wall as asked", "[property]") {
    const auto models = property_models();
    const auto m = GENERATE(range(0, 11));
    REQUIRE(models.size() == 11);
    // The models meet a connected, a striped and a fully disconnected pattern in turn, each with a seed of its own.
    const std::array<const char*, 3> patterns = {"cells", "zebra", "dots"};
    check_carved(models.at(static_cast<std::size_t>(m)), patterns.at(static_cast<std::size_t>(m) % 3),
                 static_cast<std::uint64_t>(m) + 1);
}

// Minutes, not seconds: hidden from the plain run; the build target `sweep` runs it.
TEST_CASE("carve: every model with every kind of pattern and several seeds", "[.sweep]") {
    for (const PropertyModel& model : property_models())
        for (const char* pattern : {"cells", "zebra", "dots", "hooks", "celtic", "lace"})
            for (const std::uint64_t seed : {21U, 22U}) check_carved(model, pattern, seed);
}

TEST_CASE("carve: no feature thinner and no hole narrower than asked", "[property]") {
    const auto models = property_models();
    const auto m = GENERATE(0, 1, 2);
    const PropertyModel& model = models.at(static_cast<std::size_t>(m));
    const std::string pattern = GENERATE("cells", "zebra", "hooks");
    CAPTURE(model.name, pattern);
    const CarveResult result = carve_model(model, pattern, 5);
    const double voxel = result.report.shell.voxel_mm;

    // The width of holes is known to the spacing of the samples on either side. The voxels of a sharp edge belong to
    // both faces, and widths there are not told; only the vase has such edges, at its foot and lip.
    const double spacing = 0.25 * voxel;
    const double feature = result.report.mesh.min_feature_mm;
    const double hole = result.report.mesh.min_hole_mm - 2.0 * spacing;
    const auto off_edges = [&](const Vec3& p) {
        return model.name != "vase" || (p[2] > 1.5 * feature && p[2] < 50.0 - 1.5 * feature);
    };
    const WidthJudgement judged = judge_widths(
        result.surface, result.carved.mesh, 0.3 * result.report.shell.thickness_mm, spacing, feature, hole, off_edges);
    CHECK(judged.samples > 10000);
    CHECK(judged.solid_share > 0.2);
    CHECK(judged.solid_share < 0.95);
    CHECK(judged.too_thin_share < 0.0005);
    CHECK(judged.too_narrow_share < 0.0005);
}

TEST_CASE("the width oracle tells wide stripes from narrow ones", "[property]") {
    // A box wall cut into bars: 1 mm bars with 1 mm gaps on a 12 mm square.
    const TriangleMesh surface = translated(make_square(12.0, 1), Vec3(0, 0, 1));
    TriangleMesh bars;
    for (int k = 0; k < 6; ++k) bars = joined(bars, make_box(Vec3(2.0 * k, 0, 0), Vec3(2.0 * k + 1.0, 12, 1)));
    const WidthJudgement fits = judge_widths(surface, bars, 0.5, 0.08, 0.8, 0.8);
    CHECK(fits.solid_share == Approx(0.5).margin(0.03));
    CHECK(fits.too_thin_share < 0.01);
    CHECK(fits.too_narrow_share < 0.01);
    const WidthJudgement too_much = judge_widths(surface, bars, 0.5, 0.08, 1.3, 1.3);
    // One bar and one gap of six lie at the border of the sheet, where nothing bounds them.
    CHECK(too_much.too_thin_share > 0.8);
    CHECK(too_much.too_narrow_share > 0.8);
}

}  // namespace
}  // namespace fretwork::testing
