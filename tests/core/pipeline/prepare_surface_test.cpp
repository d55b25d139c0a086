#include "core/pipeline/prepare_surface.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <string>

#include "support/make_meshes.h"

namespace fretwork {
namespace {

std::size_t warnings_with(const PreparedSurface& surface, const std::string& word) {
    return static_cast<std::size_t>(std::count_if(surface.warnings.begin(), surface.warnings.end(),
                                                  [&](const auto& w) { return w.find(word) != std::string::npos; }));
}

TEST_CASE("prepare surface: parts that touch are no self-intersection, parts that cross are", "[pipeline]") {
    const PreparedSurface touching = prepare_surface(testing::scaled(testing::make_boxes_sharing_edge(), 10.0), {});
    CHECK(touching.found.self_intersections == 0);
    CHECK(warnings_with(touching, "intersects itself") == 0);

    const TriangleMesh box = testing::make_box(Vec3::Zero(), Vec3(40, 40, 40));
    const PreparedSurface crossing =
        prepare_surface(testing::joined(box, testing::translated(box, Vec3(19, 17, 13))), {});
    CHECK(crossing.found.self_intersections > 0);
    CHECK(warnings_with(crossing, "intersects itself") == 1);

    const PreparedSurface not_counted = prepare_surface(
        testing::joined(box, testing::translated(box, Vec3(19, 17, 13))), {}, CountSelfIntersections::kNo);
    CHECK_FALSE(not_counted.found.self_intersections_counted);
    CHECK(warnings_with(not_counted, "intersects itself") == 0);
    CHECK(not_counted.mesh.triangles == crossing.mesh.triangles);
}

TEST_CASE("prepare surface: an open model is told once, a closed one not at all", "[pipeline]") {
    const PreparedSurface bowl = prepare_surface(testing::make_open_bowl(20.0, 8, 16), {});
    CHECK(bowl.open);
    CHECK(warnings_with(bowl, "open") == 1);
    const PreparedSurface box = prepare_surface(testing::make_box(Vec3::Zero(), Vec3(40, 40, 40)), {});
    CHECK_FALSE(box.open);
    CHECK(warnings_with(box, "open") == 0);
}

}  // namespace
}  // namespace fretwork
