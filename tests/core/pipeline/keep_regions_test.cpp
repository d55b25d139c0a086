// Regions that speak of the file, turned to the mesh that is carved.
#include "core/pipeline/keep_regions.h"

#include <catch2/catch.hpp>

#include "core/base/error.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

std::vector<std::uint32_t> triangles_of(const Settings& settings) {
    return std::get<TriangleSetRegion>(settings.keep.at(0).shape).triangles;
}

PreparedSurface prepared(std::vector<std::uint32_t> source_triangles) {
    PreparedSurface surface;
    surface.source_triangles = std::move(source_triangles);
    return surface;
}

TEST_CASE("regions: names of faces and parts stand for their triangles", "[pipeline]") {
    const std::vector<NamedTriangles> named = {{"Face1", 0, 2}, {"Face2", 2, 1}, {"lid", 0, 1}, {"lid", 4, 1}};
    const FileTriangles file{5, named};
    // Repair has dropped triangle 1 of the file and cut triangle 2 in two.
    const std::vector<std::uint32_t> source = {0, 2, 2, 3, 4};
    const auto turned = [&](std::vector<std::string> names) {
        Settings settings;
        settings.keep.push_back({"top", NamedRegion{std::move(names)}});
        return triangles_of(regions_on(prepared(source), file, settings));
    };
    CHECK(turned({"Face1"}) == std::vector<std::uint32_t>{0});
    CHECK(turned({"Face2"}) == std::vector<std::uint32_t>{1, 2});
    CHECK(turned({"lid", "Face1"}) == std::vector<std::uint32_t>{0, 4});
    CHECK_THROWS_WITH(turned({"Face1", "Face9"}),
                      Catch::Contains("'top'") && Catch::Contains("'Face9'") && Catch::Contains("Face1, Face2, lid"));
}

TEST_CASE("regions: a name in a model without names is refused", "[pipeline][errors]") {
    Settings settings;
    settings.keep.push_back({"top", NamedRegion{{"Face1"}}});
    CHECK_THROWS_AS(regions_on(prepared({0, 1}), {2, {}}, settings), InvalidSetting);
}

TEST_CASE("regions: named ones are turned wherever regions stand", "[pipeline]") {
    const std::vector<NamedTriangles> named = {{"Face1", 1, 1}};
    Settings settings;
    const Region region{"r", NamedRegion{{"Face1"}}};
    settings.carve.push_back(region);
    settings.loads.push_back({region, "a", Vec3(0, 0, 1), 0.0});
    settings.fixtures.push_back({region, ""});
    const Settings local = regions_on(prepared({0, 1}), {2, named}, settings);
    for (const Region* turned : {&local.carve[0], &local.loads[0].region, &local.fixtures[0].region})
        CHECK(std::get<TriangleSetRegion>(turned->shape).triangles == std::vector<std::uint32_t>{1});
}

TEST_CASE("regions: a volume is turned and scaled with its model", "[pipeline]") {
    const TriangleMesh box = testing::make_box(Vec3(1, 2, 3), Vec3(4, 5, 9), {1, 1, 1});
    Settings settings;
    settings.input.up = UpAxis::kY;
    settings.input.size_mm = 50.0;
    settings.keep.push_back({"block", VolumeRegion{box}});
    const PreparedSurface surface = prepare_surface(box, settings.input);
    const Settings local = regions_on(surface, {box.triangles.size(), {}}, settings);
    const TriangleMesh& moved = std::get<VolumeRegion>(local.keep[0].shape).surface;
    REQUIRE(moved.positions_mm.size() == surface.mesh.positions_mm.size());
    for (std::size_t v = 0; v < moved.positions_mm.size(); ++v)
        CHECK(moved.positions_mm[v] == surface.mesh.positions_mm[v]);
}

}  // namespace
}  // namespace fretwork
