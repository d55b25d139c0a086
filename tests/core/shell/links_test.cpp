// Which voxels are neighbours: those that the surface joins.
#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/shell/components.h"
#include "core/shell/voxelize.h"
#include "shell_fixtures.h"

namespace fretwork {
namespace {

using namespace testing;

// Components of the mesh over shared edges, by the plainest means.
std::size_t count_mesh_components(const TriangleMesh& mesh) {
    std::vector<std::size_t> group(mesh.triangles.size());
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t> first_user;
    const auto root = [&](std::size_t t) {
        while (group[t] != t) t = group[t];
        return t;
    };
    for (std::size_t t = 0; t < group.size(); ++t) group[t] = t;
    for (std::size_t t = 0; t < group.size(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const auto edge = std::minmax(mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3]);
            if (edge.first == edge.second) continue;
            const auto [user, added] = first_user.insert({edge, t});
            if (!added) group[root(t)] = root(user->second);
        }
    std::size_t count = 0;
    for (std::size_t t = 0; t < group.size(); ++t) count += group[t] == t;
    return count;
}

TEST_CASE("voxelize: in a flat layer the links are the king's moves of a chess board", "[shell]") {
    for (const int cells : {1, 5, 40}) {
        CAPTURE(cells);
        const SurfaceVoxels shell = voxelize(make_square(16.0, cells), {.resolution = 16});
        const auto at = [](int x, int y) { return static_cast<VoxelIndex>(17 * y + x); };
        REQUIRE(shell.size() == 17u * 17u);
        for (int y = 0; y < 17; ++y)
            for (int x = 0; x < 17; ++x) {
                std::vector<VoxelIndex> expected;
                for (int b = std::max(0, y - 1); b <= std::min(16, y + 1); ++b)
                    for (int a = std::max(0, x - 1); a <= std::min(16, x + 1); ++a)
                        if (a != x || b != y) expected.push_back(at(a, b));
                const auto row = shell.adjacency.of(at(x, y));
                CHECK(std::vector<VoxelIndex>(row.begin(), row.end()) == expected);
                for (std::uint32_t e = shell.adjacency.first[at(x, y)]; e < shell.adjacency.first[at(x, y) + 1]; ++e) {
                    const VoxelCoord& w = shell.coords[shell.adjacency.neighbor[e]];
                    CHECK(shell.adjacency.length_voxels[e] == Approx(std::hypot(w[0] - x, w[1] - y)));
                }
            }
    }
}

TEST_CASE("voxelize: a connected surface gives a connected shell, and separate ones stay separate",
          "[shell][property]") {
    const int resolution = GENERATE(8, 23, 64);
    CAPTURE(resolution);
    for (const auto& [name, mesh] : assorted_meshes()) {
        CAPTURE(name);
        const SurfaceVoxels shell = voxelize(mesh, {.resolution = resolution});
        const ShellComponents found = connected_components(shell.adjacency);
        const std::size_t expected = count_mesh_components(mesh);
        CHECK(found.count() == expected);
        // The component of an entry is that of its triangles.
        std::set<std::uint32_t> ids(shell.components.begin(), shell.components.end());
        CHECK(ids.size() == expected);
        CHECK(*ids.rbegin() + 1 == expected);
        for (std::size_t v = 0; v < shell.size(); ++v)
            for (const VoxelIndex w : shell.adjacency.of(static_cast<VoxelIndex>(v)))
                REQUIRE(shell.components[v] == shell.components[w]);
    }
}

TEST_CASE("voxelize: components are numbered by their lowest triangle", "[shell]") {
    const TriangleMesh low = make_icosphere(3, 2, {0, 0, -10});
    const TriangleMesh high = make_icosphere(3, 2, {0, 0, 10});
    for (const bool low_first : {true, false}) {
        const SurfaceVoxels shell = voxelize(low_first ? joined(low, high) : joined(high, low), {.resolution = 32});
        CHECK(shell.components.front() == (low_first ? 0u : 1u));
        CHECK(shell.components.back() == (low_first ? 1u : 0u));
    }
}

TEST_CASE("voxelize: links are symmetric, sorted and between touching cells", "[shell][property]") {
    for (const auto& [name, mesh] : assorted_meshes()) {
        CAPTURE(name);
        const SurfaceVoxels shell = voxelize(mesh, {.resolution = 20});
        REQUIRE(shell.adjacency.first.size() == shell.size() + 1);
        for (VoxelIndex v = 0; v < shell.size(); ++v) {
            const auto row = shell.adjacency.of(v);
            for (std::size_t i = 0; i < row.size(); ++i) {
                if (i > 0) REQUIRE(row[i - 1] < row[i]);
                const auto back = shell.adjacency.of(row[i]);
                REQUIRE(std::binary_search(back.begin(), back.end(), v));
                int squared = 0;
                for (std::size_t k = 0; k < 3; ++k) {
                    const int d = shell.coords[row[i]][k] - shell.coords[v][k];
                    REQUIRE(std::abs(d) <= 1);
                    squared += d * d;
                }
                REQUIRE(squared >= 1);
                REQUIRE(shell.adjacency.length_voxels[shell.adjacency.first[v] + i] ==
                        Approx(std::sqrt(static_cast<float>(squared))));
            }
        }
    }
}

// Which side of the plate an entry away from the rim is on.
enum class Side { kTop, kBottom };

TEST_CASE("voxelize: the two sides of a thin plate meet at the rim alone", "[shell][property]") {
    // Down to a fiftieth of a voxel; at 0.3 and less both sides run through the same cells.
    const double thickness_voxels = GENERATE(0.02, 0.3, 0.9, 1.0, 1.3, 2.0);
    const double angle = GENERATE(0.0, 0.37);
    CAPTURE(thickness_voxels, angle);
    const double voxel = 0.5;
    const double side = 16.0;
    const TriangleMesh flat = make_thin_plate(side, side, thickness_voxels * voxel);
    const Vec3 axis = Vec3(1, 0.6, 0.2).normalized();
    const TriangleMesh mesh = rotated(flat, axis, angle);
    const SurfaceVoxels shell = voxelize(mesh, {.resolution = static_cast<int>(side / voxel)});
    // Undo the rotation to know how far an entry is from the rim.
    TriangleMesh points;
    points.positions_mm = shell.points_mm;
    points = rotated(points, axis, -angle);
    const auto rim_distance = [&](VoxelIndex v) {
        const Vec3& p = points.positions_mm[v];
        return std::min({p[0], p[1], side - p[0], side - p[1]});
    };
    const auto side_of = [&](VoxelIndex v) {
        return points.positions_mm[v][2] > 0.5 * thickness_voxels * voxel ? Side::kTop : Side::kBottom;
    };
    // A cell with rim in it reaches at most one diagonal inward, and what is linked to it one more.
    const double reach = 2 * std::sqrt(3.0) * shell.grid.voxel_mm;
    std::size_t inner[2] = {0, 0};
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        if (rim_distance(v) < reach) continue;
        ++inner[side_of(v) == Side::kTop];
        const float sign = side_of(v) == Side::kTop ? 1.0F : -1.0F;
        TriangleMesh normal;
        normal.positions_mm = {shell.normals[v].cast<double>()};
        CHECK(sign * rotated(normal, axis, -angle).positions_mm[0][2] > 0.999);
        for (const VoxelIndex w : shell.adjacency.of(v)) CHECK(side_of(w) == side_of(v));
    }
    // Where both sides keep cells of their own up to the rim, not even there a link leads from one to the other.
    if (thickness_voxels >= 0.9 && angle == 0.0)
        for (VoxelIndex v = 0; v < shell.size(); ++v)
            for (const VoxelIndex w : shell.adjacency.of(v)) CHECK(shell.normals[v].dot(shell.normals[w]) > -0.5F);
    // Each side has its own entries: as many as cells of the side's area, at least.
    CHECK(inner[0] > 600);
    CHECK(inner[1] > 600);
    CHECK(connected_components(shell.adjacency).count() == 1);
}

TEST_CASE("voxelize: walls closer than a voxel do not mix, be they of one body or of two", "[shell][property]") {
    // Gap of 0.3 voxels between two boxes, and between two concentric spheres.
    const TriangleMesh boxes = joined(make_box({0, 0, 0}, {8, 10, 10}), make_box({8.1, 0, 0}, {16, 10, 10}));
    for (const int resolution : {32, 48}) {
        const SurfaceVoxels shell = voxelize(boxes, {.resolution = resolution});
        CHECK(connected_components(shell.adjacency).count() == 2);
        std::size_t shared_cells = 0;
        for (std::size_t v = 1; v < shell.size(); ++v) shared_cells += shell.coords[v] == shell.coords[v - 1];
        CHECK(shared_cells > 300);  // the case is the one meant: both walls in one cell
    }
    const SurfaceVoxels spheres = voxelize(make_nested_spheres(10, 9.9), {.resolution = 40});
    CHECK(connected_components(spheres.adjacency).count() == 2);
    for (std::size_t v = 0; v < spheres.size(); ++v) {
        const double along = spheres.normals[v].cast<double>().dot(spheres.points_mm[v].normalized());
        CHECK((spheres.components[v] == spheres.components[0] ? along : -along) > 0.9);
    }
}

TEST_CASE("voxelize: the sides of a blade are one sheet at its edge only, though they share that edge as triangles",
          "[shell]") {
    // Two triangles 16 mm long that open by a fifth of a voxel over their length.
    TriangleMesh mesh;
    mesh.positions_mm = {{0, 0, 0}, {0, 16, 0}, {16, 8, 0.1}, {16, 8, -0.1}};
    mesh.triangles = {{0, 2, 1}, {0, 1, 3}};
    const SurfaceVoxels shell = voxelize(mesh, {.resolution = 16});
    std::size_t at_edge = 0;
    std::size_t behind = 0;
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        const std::size_t listed =
            static_cast<std::size_t>(std::count(shell.coords.begin(), shell.coords.end(), shell.coords[v]));
        CHECK(listed == (shell.coords[v][0] == 0 ? 1 : 2));
        (shell.coords[v][0] == 0 ? at_edge : behind) += 1;
        if (shell.coords[v][0] < 2) continue;
        for (const VoxelIndex w : shell.adjacency.of(v)) CHECK(shell.normals[v].dot(shell.normals[w]) > 0.9F);
    }
    CHECK(at_edge == 17);
    CHECK(behind > 200);
    CHECK(connected_components(shell.adjacency).count() == 1);
}

TEST_CASE("voxelize: around a sharp edge the two faces are linked over the cells of the edge", "[shell]") {
    const SurfaceVoxels shell = voxelize(make_box({0, 0, 0}, {16, 16, 16}), {.resolution = 16});
    // Steps from the middle of the top to the middle of the side +x: 8 to the edge and 8 down, as on the surface.
    const auto find = [&](const VoxelCoord& c) {
        const auto at = std::find(shell.coords.begin(), shell.coords.end(), c);
        REQUIRE(at != shell.coords.end());
        return static_cast<VoxelIndex>(at - shell.coords.begin());
    };
    std::vector<int> steps(shell.size(), -1);
    std::vector<VoxelIndex> open = {find({8, 8, 16})};
    steps[open[0]] = 0;
    for (std::size_t i = 0; i < open.size(); ++i)
        for (const VoxelIndex w : shell.adjacency.of(open[i]))
            if (steps[w] < 0) {
                steps[w] = steps[open[i]] + 1;
                open.push_back(w);
            }
    CHECK(steps[find({16, 8, 16})] == 8);
    // One step fewer than 16 where the diagonal past the edge's cell is taken.
    CHECK(steps[find({16, 8, 8})] == 15);
    CHECK(*std::min_element(steps.begin(), steps.end()) == 0);
}

}  // namespace
}  // namespace fretwork
