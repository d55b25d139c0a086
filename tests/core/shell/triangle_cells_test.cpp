#include "core/shell/triangle_cells.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "core/base/counter_random.h"

namespace fretwork {
namespace {

double uniform(std::uint64_t seed, std::uint32_t item, std::uint32_t draw, double low, double high) {
    return low + (high - low) * unit_interval(counter_random(seed, RandomStream::kTest, 1, item, draw));
}

Corners random_triangle(std::uint64_t seed, std::uint32_t item, double low, double high) {
    Corners t;
    for (std::uint32_t c = 0; c < 3; ++c)
        for (std::uint32_t k = 0; k < 3; ++k) t[c][k] = uniform(seed, item, 3 * c + k, low, high);
    return t;
}

Vec3 normal_of(const Corners& t) {
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    return n.norm() > 0.0 ? Vec3(n.normalized()) : Vec3::Zero();
}

std::vector<Patch> cut(const Corners& triangle, const VoxelCoord& extent) {
    TriangleMesh mesh;
    mesh.positions_mm.assign(triangle.begin(), triangle.end());
    mesh.triangles = {{0, 1, 2}};
    const VoxelGrid grid = {Vec3::Zero(), 1.0, extent};
    std::vector<Patch> patches;
    cut_triangle(lay_into_grid(mesh, grid), 0, extent, 0, extent[2], patches, {});
    return patches;
}

VoxelCoord cell_of(const Patch& patch, int extent_x) {
    return {static_cast<int>(patch.row_x) % extent_x, static_cast<int>(patch.row_x) / extent_x,
            static_cast<int>(patch.z)};
}

Vec3 center_of(const VoxelCoord& c) {
    return {c[0] + 0.5, c[1] + 0.5, c[2] + 0.5};
}

TEST_CASE("triangle_meets_cell: a cube is met exactly from the distance at which a flat triangle grazes it",
          "[shell]") {
    const Vec3 center(0.5, 0.5, 0.5);
    // The plane x + y + z = s touches the unit cube's corner (1, 1, 1) at s = 3.
    for (const double s : {2.9, 3.0 - 1e-6, 3.0, 3.0 + 1e-6, 3.1}) {
        CAPTURE(s);
        const Corners t = {Vec3(s, 0, 0), Vec3(0, s, 0), Vec3(0, 0, s)};
        CHECK(triangle_meets_cell(t, center) == (s <= 3.0));
    }
    // A face on the far plane of the closed cube counts.
    CHECK(triangle_meets_cell({Vec3(1, -5, -5), Vec3(1, 9, -5), Vec3(1, 0, 9)}, center));
    CHECK_FALSE(triangle_meets_cell({Vec3(1 + 1e-6, -5, -5), Vec3(1 + 1e-6, 9, -5), Vec3(1 + 1e-6, 0, 9)}, center));
    // An edge that passes the cube's edge diagonally: no face or triangle normal separates the two, only the
    // product of the edges does.
    const Corners past_edge = {Vec3(1.2, 0.9, -1), Vec3(0.9, 1.2, 2), Vec3(3, 3, 0.5)};
    CHECK_FALSE(triangle_meets_cell(past_edge, center));
}

TEST_CASE("triangle_meets_cell: degenerate triangles are the segment or point they are", "[shell]") {
    const Vec3 center(0.5, 0.5, 0.5);
    CHECK(triangle_meets_cell({Vec3(1, 1, 1), Vec3(1, 1, 1), Vec3(1, 1, 1)}, center));
    CHECK_FALSE(triangle_meets_cell({Vec3(1, 1, 1.001), Vec3(1, 1, 1.001), Vec3(1, 1, 1.001)}, center));
    CHECK(triangle_meets_cell({Vec3(-1, -1, -1), Vec3(2, 2, 2), Vec3(0, 0, 0)}, center));
    CHECK_FALSE(triangle_meets_cell({Vec3(-1, 1.4, 0.5), Vec3(1.5, 1.4, 0.5), Vec3(0, 1.4, 0.5)}, center));
}

TEST_CASE("triangle_meets_cell and segment_meets_cell agree with dense sampling", "[shell][property]") {
    const Vec3 center(0.5, 0.5, 0.5);
    int met = 0;
    int missed = 0;
    for (std::uint32_t item = 0; item < 300; ++item) {
        const Corners t = random_triangle(11, item, -1.5, 2.5);
        constexpr int steps = 60;
        double closest = std::numeric_limits<double>::infinity();
        double closest_on_edge = closest;
        for (int i = 0; i <= steps; ++i)
            for (int j = 0; i + j <= steps; ++j) {
                const Vec3 p = t[0] + (i * (t[1] - t[0]) + j * (t[2] - t[0])) / steps;
                const double outside = (p - center).cwiseAbs().maxCoeff() - 0.5;
                closest = std::min(closest, outside);
                if (j == 0) closest_on_edge = std::min(closest_on_edge, outside);
            }
        // No point is farther than `slack` from a sample.
        const double slack = ((t[1] - t[0]).norm() + (t[2] - t[0]).norm()) / steps;
        CAPTURE(item);
        if (closest <= 0.0) CHECK(triangle_meets_cell(t, center));
        if (closest > slack) CHECK_FALSE(triangle_meets_cell(t, center));
        if (closest_on_edge <= 0.0) CHECK(segment_meets_cell(t[0], t[1], center));
        if (closest_on_edge > slack) CHECK_FALSE(segment_meets_cell(t[0], t[1], center));
        (closest <= 0.0 ? met : missed) += 1;
    }
    // The oracle says something on both sides.
    CHECK(met > 50);
    CHECK(missed > 50);
}

TEST_CASE("cut_triangle: finds every cell of the grid that passes the test and no other", "[shell][property]") {
    const VoxelCoord extent = {9, 8, 7};
    for (std::uint32_t item = 0; item < 200; ++item) {
        CAPTURE(item);
        Corners t = random_triangle(5, item, 0.3, 6.7);
        if (item % 4 == 1) t[2] = 0.3 * t[0] + 0.7 * t[1];  // a needle, down to rounding
        if (item % 4 == 2)
            for (Vec3& p : t) p = p.array().round();                                  // corners on the grid
        if (item % 4 == 3) t[item % 3] = t[(item + 1) % 3] + Vec3(1e-8, -1e-8, 0.0);  // a sliver
        std::set<VoxelCoord> found;
        for (const Patch& patch : cut(t, extent)) REQUIRE(found.insert(cell_of(patch, extent[0])).second);
        std::set<VoxelCoord> expected;
        for (int z = 0; z < extent[2]; ++z)
            for (int y = 0; y < extent[1]; ++y)
                for (int x = 0; x < extent[0]; ++x)
                    if (triangle_meets_cell(t, center_of({x, y, z}))) expected.insert({x, y, z});
        CHECK(found == expected);
    }
}

TEST_CASE("cut_triangle: the areas of the patches add up to the triangle, and so do their centres",
          "[shell][property]") {
    const VoxelCoord extent = {9, 9, 9};
    for (std::uint32_t item = 0; item < 100; ++item) {
        CAPTURE(item);
        Corners t = random_triangle(6, item, 0.3, 8.7);
        // Lying in the border between two layers, where both list it.
        if (item % 3 == 1)
            for (Vec3& p : t) p[static_cast<Eigen::Index>(item % 2)] = 4.0;
        const double whole = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]).norm();
        double sum = 0.0;
        Vec3 moment = Vec3::Zero();
        for (const Patch& patch : cut(t, extent)) {
            sum += static_cast<double>(patch.area);
            moment += static_cast<double>(patch.area) *
                      (center_of(cell_of(patch, extent[0])) + patch.centroid.cast<double>());
            CHECK(patch.centroid.cwiseAbs().maxCoeff() < 0.5F + 1e-6F);
        }
        CHECK(sum == Approx(whole).epsilon(1e-5).margin(1e-5));
        CHECK((moment - whole * (t[0] + t[1] + t[2]) / 3.0).norm() < 1e-4 * (1.0 + moment.norm()));
    }
}

TEST_CASE("cut_triangle: the closest point of a patch lies on the triangle, in the cell, and none is closer",
          "[shell][property]") {
    const VoxelCoord extent = {6, 6, 6};
    for (std::uint32_t item = 0; item < 40; ++item) {
        const Corners t = random_triangle(7, item, 0.3, 5.7);
        const Vec3 normal = normal_of(t);
        for (const Patch& patch : cut(t, extent)) {
            CAPTURE(item, patch.row_x, patch.z);
            const Vec3 center = center_of(cell_of(patch, extent[0]));
            const Vec3 p = center + patch.closest.cast<double>();
            CHECK(std::abs(normal.dot(p - t[0])) < 1e-6);
            CHECK(patch.closest.cwiseAbs().maxCoeff() < 0.5F + 1e-6F);
            for (std::size_t e = 0; e < 3; ++e) CHECK(normal.dot((t[(e + 1) % 3] - t[e]).cross(p - t[e])) > -1e-5);
            // Samples of the triangle inside the cell.
            constexpr int steps = 40;
            for (int i = 0; i <= steps; ++i)
                for (int j = 0; i + j <= steps; ++j) {
                    const Vec3 q = t[0] + (i * (t[1] - t[0]) + j * (t[2] - t[0])) / steps - center;
                    if (q.cwiseAbs().maxCoeff() <= 0.5)
                        REQUIRE(q.norm() >= static_cast<double>(patch.closest.norm()) - 1e-6);
                }
        }
    }
}

}  // namespace
}  // namespace fretwork
