#include "core/strength/voxel_model.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/mesh/closest_point.h"
#include "strength_fixtures.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

TEST_CASE("voxel model: a box of whole voxels becomes those voxels", "[strength]") {
    // Triangles' diagonals run through the centres of voxels, and lines of centres meet vertices.
    const TriangleMesh box = make_box(Vec3(-3, 2, 5), Vec3(7, 8, 9), {4, 3, 8});
    for (const double voxel_mm : {1.0, 0.5, 2.0}) {
        CAPTURE(voxel_mm);
        const VoxelModel model = make_voxel_model(box, voxel_mm);
        const auto n = [&](double mm) { return static_cast<std::size_t>(std::lround(mm / voxel_mm)); };
        CHECK(model.voxels.size() == n(10) * n(6) * n(4));
        CHECK(model.nodes.size() == (n(10) + 1) * (n(6) + 1) * (n(4) + 1));
        CHECK(model.pieces == 1);
        CHECK(model.joining_voxels == 0);
        CHECK((model.node_mm(0) - Vec3(-3, 2, 5)).norm() < 1e-12);
        CHECK((model.node_mm(static_cast<NodeIndex>(model.nodes.size() - 1)) - Vec3(7, 8, 9)).norm() < 1e-12);
    }
}

TEST_CASE("voxel model: voxels are those whose centres are inside", "[strength][property]") {
    const std::vector<TriangleMesh> meshes = {rotated(make_bracket(), Vec3(1, 2, 3), 0.7), make_torus(20, 6, 48, 24),
                                              make_linked_tori(20, 4, 24, 12), make_nested_spheres(10, 7),
                                              rotated(make_frame(20, 4), Vec3(0, 1, 1), 0.3)};
    for (std::size_t i = 0; i < meshes.size(); ++i) {
        CAPTURE(i);
        const VoxelModel model = make_voxel_model(meshes[i], 0.83);
        const SurfaceTree tree(meshes[i]);
        const std::set<VoxelCoord> solid(model.voxels.begin(), model.voxels.end());
        std::size_t wrong = 0, inside = 0;
        for (std::int32_t z = 0; z < model.grid.extent[2]; ++z)
            for (std::int32_t y = 0; y < model.grid.extent[1]; ++y)
                for (std::int32_t x = 0; x < model.grid.extent[0]; ++x) {
                    const bool is_inside = tree.inside(model.grid.center_mm({x, y, z}));
                    inside += is_inside ? 1 : 0;
                    wrong += is_inside != solid.contains({x, y, z}) ? 1 : 0;
                }
        CHECK(inside > 1000);
        CHECK(wrong == model.joining_voxels);
    }
}

TEST_CASE("voxel model: overlapping bodies are one, and inverted ones nothing", "[strength]") {
    CHECK(make_voxel_model(make_overlapping_boxes(), 0.25).voxels.size() == (2 * 8 - 1) * 64);
    CHECK_THROWS_AS(make_voxel_model(inverted(make_box(Vec3::Zero(), Vec3::Ones())), 0.25), InvalidInput);
}

TEST_CASE("voxel model: corners are in the order of VTK and shared", "[strength]") {
    const VoxelModel model = full_block({2, 1, 1}, 0.5);
    REQUIRE(model.nodes.size() == 12);
    const std::array<Vec3, 8> expected{Vec3(0, 0, 0),   Vec3(0.5, 0, 0),   Vec3(0.5, 0.5, 0),   Vec3(0, 0.5, 0),
                                       Vec3(0, 0, 0.5), Vec3(0.5, 0, 0.5), Vec3(0.5, 0.5, 0.5), Vec3(0, 0.5, 0.5)};
    for (std::size_t c = 0; c < 8; ++c) CHECK((model.node_mm(model.corners[0][c]) - expected[c]).norm() == 0.0);
    CHECK(model.corners[0][1] == model.corners[1][0]);
    CHECK(model.corners[0][6] == model.corners[1][7]);
}

TEST_CASE("voxel model: hinges are filled by one voxel or two", "[strength]") {
    const VoxelGrid grid{Vec3::Zero(), 1.0, {4, 4, 4}};
    const VoxelModel by_edge = make_voxel_model(grid, {{0, 0, 0}, {1, 1, 0}});
    CHECK(by_edge.voxels.size() == 3);
    CHECK(by_edge.joining_voxels == 1);
    CHECK(by_edge.pieces == 1);
    const VoxelModel by_corner = make_voxel_model(grid, {{2, 2, 2}, {1, 1, 1}});
    CHECK(by_corner.voxels.size() == 4);
    CHECK(by_corner.pieces == 1);
    const VoxelModel apart = make_voxel_model(grid, {{0, 0, 0}, {2, 0, 0}});
    CHECK(apart.voxels.size() == 2);
    CHECK(apart.pieces == 2);
    CHECK(apart.piece == std::vector<std::uint32_t>{0, 1});
    // An edge within one piece is no hinge: three voxels round a corner.
    CHECK(make_voxel_model(grid, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}).joining_voxels == 0);
}

TEST_CASE("voxel model: pieces never share a node", "[strength][property]") {
    for (const std::uint64_t seed : {1u, 2u, 3u}) {
        const VoxelModel model = crumbs(9, seed);
        std::vector<std::uint32_t> owner(model.nodes.size(), model.pieces);
        std::size_t torn = 0;
        for (std::size_t v = 0; v < model.voxels.size(); ++v)
            for (const NodeIndex n : model.corners[v]) {
                if (owner[n] != model.pieces && owner[n] != model.piece[v]) ++torn;
                owner[n] = model.piece[v];
            }
        CHECK(torn == 0);
        CHECK(std::ranges::count(owner, model.pieces) == 0);
    }
}

TEST_CASE("voxel model: does not depend on threads or the order of triangles", "[strength]") {
    const TriangleMesh torus = rotated(make_torus(20, 6, 48, 24), Vec3(1, 1, 0), 0.5);
    const VoxelModel expected = make_voxel_model(torus, 0.4);
    for (const int threads : {1, 2, 5}) {
        const ThreadLimit limit(threads);
        const VoxelModel model = make_voxel_model(shuffled(torus, 7), 0.4);
        CHECK(model.voxels == expected.voxels);
        CHECK(model.corners == expected.corners);
    }
}

TEST_CASE("voxel model: rejects what it cannot fill", "[strength]") {
    const TriangleMesh box = make_box(Vec3::Zero(), Vec3::Ones());
    CHECK_THROWS_AS(make_voxel_model(TriangleMesh{}, 1.0), InvalidInput);
    CHECK_THROWS_AS(make_voxel_model(box, 0.0), InvalidSetting);
    CHECK_THROWS_AS(make_voxel_model(box, 1.0 / 5000), InvalidSetting);
    TriangleMesh broken = box;
    broken.positions_mm[0][1] = std::numeric_limits<double>::quiet_NaN();
    CHECK_THROWS_AS(make_voxel_model(broken, 0.1), InvalidInput);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(make_voxel_model(box, 0.1, RunControl({}, source.get_token())), Cancelled);
}

}  // namespace
}  // namespace fretwork
