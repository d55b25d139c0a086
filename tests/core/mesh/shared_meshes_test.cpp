// The folder's promises on models from the world, where these are at hand.
#include <catch2/catch.hpp>
#include <string>

#include "core/mesh/closest_point.h"
#include "core/mesh/mesh_report.h"
#include "core/mesh/repair.h"
#include "formats/mesh_file.h"
#include "support/make_meshes.h"
#include "support/shared_data.h"

namespace fretwork {
namespace {

struct Model {
    const char* file;
    bool closed;
    std::size_t components;     ///< by the notes that come with the files
    std::size_t intersections;  ///< pairs, by the same notes
};

constexpr Model kModels[] = {
    {"bunny_cgal.off", true, 1, 0},
    {"cow.off", true, 1, 101},
    {"fandisk.obj", true, 1, 0},
    {"kitten.off", true, 1, 0},
    {"knot_2comp.off", true, 2, 0},
    {"knot_g1.off", true, 1, 0},
    {"mushroom_open.off", false, 1, 0},
    {"skull_low.obj", true, 1, 0},
    {"spot_low.obj", true, 1, 0},
    {"teapot_open.obj", false, 4, 179},
    {"truck_nonmanifold.obj", false, 50, 1956},
    {"tray_thin.stl", true, 1, 0},
};

TEST_CASE("shared meshes: repair makes every one of them sound", "[mesh][shared]") {
    for (const Model& model : kModels) {
        const auto path = testing::shared_data(std::string("meshes/") + model.file);
        if (!path) {
            WARN("skipped, not at hand: " << model.file);
            continue;
        }
        CAPTURE(model.file);
        const TriangleMesh mesh = read_mesh(*path).mesh;
        const RepairedMesh repaired = repair_mesh(mesh);
        const MeshReport report = report_mesh(repaired.mesh);
        CHECK(report.non_manifold_edges == 0);
        CHECK(report.non_manifold_vertices == 0);
        CHECK(report.flipped_edges == 0);
        CHECK(report.degenerate_triangles == 0);
        CHECK(report.duplicate_triangles == 0);
        CHECK(report.closed_manifold() == model.closed);
        if (model.closed) {
            CHECK(report.components == model.components);
            CHECK(report.volume_mm3 > 0);
            CHECK(report.volume_mm3 == Approx(std::abs(testing::volume_mm3(mesh))).epsilon(1e-9));
        }
        CHECK(report_mesh(repair_mesh(mesh).mesh).triangles == report.triangles);
    }
}

}  // namespace
}  // namespace fretwork
