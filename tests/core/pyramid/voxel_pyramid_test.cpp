#include "core/pyramid/voxel_pyramid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <random>
#include <set>
#include <stop_token>
#include <string>
#include <vector>

#include "core/base/avx2.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/pyramid/flat_ways.h"
#include "core/shell/components.h"
#include "core/shell/voxelize.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

struct NamedMesh {
    std::string name;
    TriangleMesh mesh;
};

std::vector<NamedMesh> assorted_meshes() {
    return {{"sphere", make_icosphere(10, 3)},
            {"torus", make_torus(10, 3, 40, 20)},
            {"turned box", rotated(make_box({0, 0, 0}, {10, 7, 5}), Vec3(1, 2, 3).normalized(), 0.7)},
            {"bracket", make_bracket()},
            {"thin plate", make_thin_plate(20, 15, 0.3)},
            {"thin tube", make_tube(10, 9.8, 12, 64)},
            {"open bowl", make_open_bowl(10, 12, 24)},
            {"linked tori", make_linked_tori(10, 3)},
            {"nested spheres", make_nested_spheres(10, 9)},
            {"soup", random_soup(3, 30, 20)}};
}

VoxelCoord cell_above(const VoxelCoord& c) {
    return {c[0] / 2, c[1] / 2, c[2] / 2};
}

bool linked(const Adjacency& adjacency, VoxelIndex v, VoxelIndex w) {
    const auto row = adjacency.of(v);
    return std::binary_search(row.begin(), row.end(), w);
}

std::vector<VoxelIndex> neighbors_of(const PyramidLevel& level, VoxelIndex v) {
    std::vector<VoxelIndex> row;
    for (std::uint32_t i = 0; i < level.neighborhoods.count[v]; ++i) row.push_back(level.neighborhoods.neighbor(v, i));
    return row;
}

// Place of w in the list of v.
std::uint32_t place_of(const PyramidLevel& level, VoxelIndex v, VoxelIndex w) {
    const auto row = neighbors_of(level, v);
    const auto at = std::lower_bound(row.begin(), row.end(), w);
    REQUIRE(at != row.end());
    REQUIRE(*at == w);
    return static_cast<std::uint32_t>(at - row.begin());
}

// The offset from v to w, in cells.
Vec3f offset_between(const PyramidLevel& level, VoxelIndex v, VoxelIndex w) {
    return level.neighborhoods.way_out(v, place_of(level, v, w));
}

TEST_CASE("build_pyramid: level 0 is the shell, in the units of the grid", "[pyramid]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(10, 3, {5, -3, 2}), {.resolution = 30});
    const VoxelPyramid pyramid = build_pyramid(shell, 3);
    const PyramidLevel& finest = pyramid.levels.front();
    CHECK(finest.coords == shell.coords);
    CHECK(finest.normals == shell.normals);
    CHECK(finest.adjacency.neighbor == shell.adjacency.neighbor);
    for (std::size_t v = 0; v < shell.size(); ++v) {
        const Vec3 mm = shell.grid.origin_mm + shell.grid.voxel_mm * finest.positions[v].cast<double>();
        CHECK((mm - shell.points_mm[v]).norm() < 1e-5);
    }
}

TEST_CASE("build_pyramid: the children of a level's entries are the entries of the finer level, each once",
          "[pyramid][property]") {
    for (const auto& [name, mesh] : assorted_meshes()) {
        CAPTURE(name);
        const VoxelPyramid pyramid = build_pyramid(voxelize(mesh, {.resolution = 40}), 12);
        for (std::size_t l = 0; l + 1 < pyramid.levels.size(); ++l) {
            CAPTURE(l);
            const PyramidLevel& fine = pyramid.levels[l];
            const PyramidLevel& coarse = pyramid.levels[l + 1];
            REQUIRE(fine.parent.size() == fine.size());
            REQUIRE(coarse.first_child.size() == coarse.size() + 1);
            std::vector<VoxelIndex> all = coarse.children;
            std::sort(all.begin(), all.end());
            std::vector<VoxelIndex> expected(fine.size());
            std::iota(expected.begin(), expected.end(), 0u);
            REQUIRE(all == expected);
            for (VoxelIndex p = 0; p < coarse.size(); ++p)
                for (std::uint32_t i = coarse.first_child[p]; i < coarse.first_child[p + 1]; ++i) {
                    REQUIRE(fine.parent[coarse.children[i]] == p);
                    REQUIRE(cell_above(fine.coords[coarse.children[i]]) == coarse.coords[p]);
                    if (i > coarse.first_child[p]) REQUIRE(coarse.children[i - 1] < coarse.children[i]);
                }
        }
        CHECK(pyramid.levels.front().first_child.empty());
        CHECK(pyramid.levels.back().parent.empty());
    }
}

TEST_CASE("build_pyramid: one entry per group of children that hang together inside the cell", "[pyramid][property]") {
    for (const auto& [name, mesh] : assorted_meshes()) {
        CAPTURE(name);
        const VoxelPyramid pyramid = build_pyramid(voxelize(mesh, {.resolution = 40}), 12);
        for (std::size_t l = 0; l + 1 < pyramid.levels.size(); ++l) {
            CAPTURE(l);
            const PyramidLevel& fine = pyramid.levels[l];
            // Keep only the links inside one coarse cell; their components are the parents.
            Adjacency inside;
            inside.first.push_back(0);
            for (VoxelIndex v = 0; v < fine.size(); ++v) {
                for (const VoxelIndex w : fine.adjacency.of(v))
                    if (cell_above(fine.coords[v]) == cell_above(fine.coords[w])) inside.neighbor.push_back(w);
                inside.first.push_back(static_cast<std::uint32_t>(inside.neighbor.size()));
            }
            const ShellComponents groups = connected_components(inside);
            CHECK(groups.count() == pyramid.levels[l + 1].size());
            std::set<std::pair<std::uint32_t, VoxelIndex>> pairs;
            for (VoxelIndex v = 0; v < fine.size(); ++v) pairs.insert({groups.of[v], fine.parent[v]});
            CHECK(pairs.size() == groups.count());
        }
    }
}

TEST_CASE("build_pyramid: entries are linked when children are, else around a common neighbour only",
          "[pyramid][property]") {
    for (const auto& [name, mesh] : assorted_meshes()) {
        CAPTURE(name);
        const SurfaceVoxels shell = voxelize(mesh, {.resolution = 40});
        const VoxelPyramid pyramid = build_pyramid(shell, 12);
        const std::size_t components = connected_components(shell.adjacency).count();
        for (std::size_t l = 0; l + 1 < pyramid.levels.size(); ++l) {
            CAPTURE(l);
            const PyramidLevel& fine = pyramid.levels[l];
            const PyramidLevel& coarse = pyramid.levels[l + 1];
            std::set<std::pair<VoxelIndex, VoxelIndex>> of_children;
            for (VoxelIndex v = 0; v < fine.size(); ++v)
                for (const VoxelIndex w : fine.adjacency.of(v))
                    if (fine.parent[v] != fine.parent[w]) of_children.insert({fine.parent[v], fine.parent[w]});
            for (const auto& [p, q] : of_children) REQUIRE(linked(coarse.adjacency, p, q));
            for (VoxelIndex p = 0; p < coarse.size(); ++p)
                for (const VoxelIndex q : coarse.adjacency.of(p)) {
                    REQUIRE(linked(coarse.adjacency, q, p));
                    if (of_children.contains({p, q})) continue;
                    REQUIRE(coarse.normals[p].dot(coarse.normals[q]) > -0.3F);
                    const auto row = coarse.adjacency.of(p);
                    REQUIRE(std::any_of(row.begin(), row.end(), [&](VoxelIndex c) {
                        return of_children.contains({p, c}) && of_children.contains({c, q});
                    }));
                }
            // Nothing falls apart and nothing grows together.
            CHECK(connected_components(coarse.adjacency).count() == components);
        }
    }
}

TEST_CASE("build_pyramid: positions and normals are means of the children", "[pyramid]") {
    // A square of 16 x 16 cells of equal area but for the border: the mean of four cells is their middle.
    const VoxelPyramid pyramid = build_pyramid(voxelize(make_square(15.0), {.resolution = 15}), 3);
    const PyramidLevel& coarse = pyramid.levels[1];
    REQUIRE(coarse.size() == 64);
    for (std::size_t p = 0; p < coarse.size(); ++p) {
        CHECK(coarse.normals[p] == Vec3f(0, 0, 1));
        const VoxelCoord& c = coarse.coords[p];
        if (c[0] == 0 || c[1] == 0 || c[0] == 7 || c[1] == 7) continue;
        CHECK(coarse.positions[p][0] == Approx(2.0 * c[0] + 1.0));
        CHECK(coarse.positions[p][1] == Approx(2.0 * c[1] + 1.0));
    }
    const VoxelPyramid sphere = build_pyramid(voxelize(make_icosphere(10, 4), {.resolution = 64}), 4);
    const Vec3f center = Vec3f::Constant(32.5F);
    for (std::size_t l = 0; l < sphere.levels.size(); ++l) {
        const PyramidLevel& level = sphere.levels[l];
        // Cells of 2^l voxels on a sphere of radius 32: half the diagonal of the cell, twice for its neighbours.
        const double angle = std::sqrt(3.0) * std::exp2(static_cast<double>(l)) / 32.0 + 0.05;
        for (std::size_t v = 0; v < level.size(); ++v) {
            CHECK(level.normals[v].norm() == Approx(1.0F).margin(1e-5));
            const Vec3f out = (level.positions[v] - center).normalized();
            CHECK(static_cast<double>(level.normals[v].dot(out)) > std::cos(angle));
        }
    }
}

TEST_CASE("build_pyramid: a shell of coarser cells has the coarse levels of the fine one", "[pyramid][property]") {
    // Where a cell holds one sheet only; else the two may disagree on how many there are.
    const TriangleMesh mesh = make_icosphere(10, 4);
    for (const int halvings : {1, 2}) {
        const VoxelPyramid full = build_pyramid(voxelize(mesh, {.resolution = 70}), 6);
        const VoxelPyramid draft =
            build_pyramid(voxelize(mesh, {.resolution = 70, .halvings = halvings}), 6 - halvings);
        const auto skipped = static_cast<std::size_t>(halvings);
        REQUIRE(draft.levels.size() + skipped == full.levels.size());
        const float cell = std::exp2(static_cast<float>(halvings));
        for (std::size_t l = 0; l < draft.levels.size(); ++l) {
            const PyramidLevel &a = full.levels[l + skipped], &b = draft.levels[l];
            CAPTURE(halvings, l);
            REQUIRE(a.coords == b.coords);
            for (VoxelIndex v = 0; v < a.size(); ++v) {
                REQUIRE((a.normals[v] - b.normals[v]).norm() < 1e-3F);
                // The finest level of either has points of the surface in the place of centres.
                if (l > 0) REQUIRE((a.positions[v] - cell * b.positions[v]).norm() < 1e-3F * cell);
            }
        }
    }
}

TEST_CASE("build_pyramid: sheets stay apart on every level, as long as no rim joins them", "[pyramid][property]") {
    // Two spheres a third of a voxel apart: at every level no entry mixes them.
    const SurfaceVoxels shell = voxelize(make_nested_spheres(10, 9.85), {.resolution = 64});
    const VoxelPyramid pyramid = build_pyramid(shell, 9);
    std::vector<std::uint32_t> component = shell.components;
    for (const PyramidLevel& level : pyramid.levels) {
        for (VoxelIndex v = 0; v < level.size(); ++v) {
            for (const VoxelIndex w : level.adjacency.of(v)) REQUIRE(component[w] == component[v]);
            for (const VoxelIndex w : neighbors_of(level, v)) REQUIRE(component[w] == component[v]);
        }
        if (level.parent.empty()) break;
        std::vector<std::uint32_t> above(1 + *std::max_element(level.parent.begin(), level.parent.end()), 99);
        for (VoxelIndex v = 0; v < level.size(); ++v) {
            if (above[level.parent[v]] != 99) REQUIRE(above[level.parent[v]] == component[v]);
            above[level.parent[v]] = component[v];
        }
        component = above;
    }
    CHECK(component.size() == 2);

    // The two sides of a plate thinner than a voxel: apart wherever a cell and its neighbours hold no rim.
    const VoxelPyramid plate = build_pyramid(voxelize(make_thin_plate(64, 64, 0.3), {.resolution = 64}), 4);
    for (std::size_t l = 0; l < 3; ++l) {
        const PyramidLevel& level = plate.levels[l];
        const float cell = std::exp2(static_cast<float>(l));
        for (VoxelIndex v = 0; v < level.size(); ++v) {
            const Vec3f& p = level.positions[v];
            const float rim = std::min({p[0], p[1], 65.0F - p[0], 65.0F - p[1]});
            if (rim < 4.0F * cell) continue;
            CHECK(std::abs(level.normals[v][2]) > 0.99F);
            for (const VoxelIndex w : neighbors_of(level, v)) CHECK(level.normals[v].dot(level.normals[w]) > 0.99F);
        }
    }
}

TEST_CASE("neighbourhoods: symmetric, sorted, the way back of one the way out of the other", "[pyramid][property]") {
    for (const auto& [name, mesh] : assorted_meshes()) {
        CAPTURE(name);
        const VoxelPyramid pyramid = build_pyramid(voxelize(mesh, {.resolution = 24}), 12);
        for (const PyramidLevel& level : pyramid.levels) {
            const Neighborhoods& n = level.neighborhoods;
            REQUIRE(n.first.size() == level.size() + 1);
            REQUIRE(n.count.size() == level.size());
            REQUIRE(n.blocks.size() == n.first.back());
            for (VoxelIndex v = 0; v < level.size(); ++v) {
                REQUIRE(8 * (n.first[v + 1] - n.first[v]) >= n.count[v]);
                for (std::uint32_t i = 0; i < n.count[v]; ++i) {
                    const VoxelIndex w = n.neighbor(v, i);
                    REQUIRE(w != v);
                    if (i > 0) REQUIRE(n.neighbor(v, i - 1) < w);
                    for (std::size_t k = 0; k < 3; ++k) REQUIRE(std::abs(level.coords[w][k] - level.coords[v][k]) <= 2);
                    const Vec3f out = n.way_out(v, i);
                    REQUIRE(out == n.way_back(w, place_of(level, w, v)));
                    // Ways lie in the tangent plane.
                    REQUIRE(std::abs(level.normals[v].dot(out)) < 1e-3F * (1.0F + out.norm()));
                }
                for (std::uint32_t i = n.count[v]; i % 8 != 0; ++i) {
                    REQUIRE(n.neighbor(v, i) == v);
                    REQUIRE(n.way_out(v, i) == Vec3f::Zero());
                    REQUIRE(n.way_back(v, i) == Vec3f::Zero());
                }
            }
        }
    }
}

TEST_CASE("neighbourhoods: both instruction sets lay ways flat to the same bits", "[pyramid][property]") {
    if (!machine_has_avx2()) return;
    std::mt19937 rng(7);
    std::uniform_real_distribution<float> place(-3.0F, 3.0F);
    const auto random_vector = [&] { return Vec3f(place(rng), place(rng), place(rng)); };
    std::vector<SurfaceFrame> frames;
    for (int i = 0; i < 300; ++i) {
        const Vec3f p = random_vector(), n = (0.3F * random_vector() + Vec3f(0, 0, 1)).normalized();
        frames.push_back({{p.x(), p.y(), p.z(), 0.0F}, {n.x(), n.y(), n.z(), 0.0F}});
    }
    std::uint32_t bent = 0;
    for (VoxelIndex v = 0; v < frames.size(); ++v) {
        NeighborBlock plain{}, fast{};
        for (std::size_t lane = 0; lane < 8; ++lane)
            plain.neighbor[lane] = fast.neighbor[lane] = lane == 7 ? v : static_cast<VoxelIndex>(rng() % 300);
        const float unit = std::ldexp(4096.0F, -static_cast<int>(v % 3));
        const std::uint32_t lanes = lay_flat_portable(frames.data(), v, unit, plain);
        REQUIRE(lay_flat_avx2(frames.data(), v, unit, fast) == lanes);
        bent |= lanes;
        REQUIRE(std::memcmp(&plain, &fast, sizeof plain) == 0);
        CHECK(plain.out_xy[7] == 0);
        CHECK(plain.z[7] == 0);
    }
    CHECK((bent & 0x7Fu) == 0x7Fu);
}

TEST_CASE("neighbourhoods: N(v) is what two steps that do not turn round reach", "[pyramid][property]") {
    for (const auto& [name, mesh] : assorted_meshes()) {
        CAPTURE(name);
        const VoxelPyramid pyramid = build_pyramid(voxelize(mesh, {.resolution = 16}), 3);
        for (const PyramidLevel& level : pyramid.levels) {
            const auto step = [&](VoxelIndex a, VoxelIndex b) {
                return level.normals[a].dot(level.normals[b]) >= -0.2F;
            };
            for (VoxelIndex v = 0; v < level.size(); ++v) {
                std::set<VoxelIndex> expected;
                for (const VoxelIndex u : level.adjacency.of(v)) {
                    if (!step(v, u)) continue;
                    expected.insert(u);
                    for (const VoxelIndex w : level.adjacency.of(u))
                        if (w != v && step(u, w)) expected.insert(w);
                }
                const auto row = neighbors_of(level, v);
                REQUIRE(std::vector<VoxelIndex>(row.begin(), row.end()) ==
                        std::vector<VoxelIndex>(expected.begin(), expected.end()));
            }
        }
    }
}

TEST_CASE("neighbourhoods: on smooth surfaces they hold the whole sheet inside the 5x5x5 cube", "[pyramid][property]") {
    for (const TriangleMesh& mesh : {make_icosphere(10, 4), make_torus(10, 4, 96, 48)}) {
        const VoxelPyramid pyramid = build_pyramid(voxelize(mesh, {.resolution = 64}), 3);
        for (std::size_t l = 0; l < 3; ++l) {
            CAPTURE(l);
            const PyramidLevel& level = pyramid.levels[l];
            std::size_t reached = 0;
            std::size_t found = 0;
            for (VoxelIndex v = 0; v < level.size(); ++v) {
                std::vector<VoxelIndex> open = {v};
                std::set<VoxelIndex> seen = {v};
                for (std::size_t i = 0; i < open.size(); ++i)
                    for (const VoxelIndex w : level.adjacency.of(open[i])) {
                        bool inside = true;
                        for (std::size_t k = 0; k < 3; ++k)
                            inside &= std::abs(level.coords[w][k] - level.coords[v][k]) <= 2;
                        if (inside && seen.insert(w).second) open.push_back(w);
                    }
                reached += seen.size() - 1;
                found += neighbors_of(level, v).size();
            }
            CHECK(found <= reached);
            CHECK(static_cast<double>(found) > 0.95 * static_cast<double>(reached));
            const double mean = static_cast<double>(found) / static_cast<double>(level.size());
            CHECK(mean > 36.0);
            CHECK(mean < 44.0);
        }
    }
}

TEST_CASE("neighbourhoods: on a plane the offset is the way itself", "[pyramid][property]") {
    const double angle = GENERATE(0.0, 0.3, 0.8);
    const TriangleMesh mesh = rotated(make_square(30.0, 3), Vec3(0.5, 1, 0.2).normalized(), angle);
    const VoxelPyramid pyramid = build_pyramid(voxelize(mesh, {.resolution = 30}), 3);
    for (std::size_t l = 0; l < pyramid.levels.size(); ++l) {
        const PyramidLevel& level = pyramid.levels[l];
        const float voxels_per_cell = std::exp2(static_cast<float>(l));
        for (VoxelIndex v = 0; v < level.size(); ++v)
            for (const VoxelIndex w : neighbors_of(level, v))
                REQUIRE(
                    (voxels_per_cell * offset_between(level, v, w) - (level.positions[w] - level.positions[v])).norm() <
                    1e-3F * voxels_per_cell);
    }
}

TEST_CASE("neighbourhoods: on a sphere the offset is the arc of the great circle", "[pyramid][property]") {
    const double radius = 32.0;
    const VoxelPyramid pyramid = build_pyramid(voxelize(make_icosphere(10, 5), {.resolution = 64}), 2);
    const Vec3 center = Vec3::Constant(32.5);
    for (std::size_t l = 0; l < 2; ++l) {
        const PyramidLevel& level = pyramid.levels[l];
        double worst = 0.0;
        double sum = 0.0;
        std::size_t pairs = 0;
        for (VoxelIndex v = 0; v < level.size(); ++v) {
            const Vec3 a = (level.positions[v].cast<double>() - center).normalized();
            for (const VoxelIndex w : neighbors_of(level, v)) {
                const Vec3 b = (level.positions[w].cast<double>() - center).normalized();
                const double arc = std::acos(std::clamp(a.dot(b), -1.0, 1.0));
                const Vec3 along = (b - a * a.dot(b)).normalized();
                const Vec3 offset = std::exp2(static_cast<double>(l)) * offset_between(level, v, w).cast<double>();
                const double error = (offset - radius * arc * along).norm();
                worst = std::max(worst, error);
                sum += error;
                ++pairs;
            }
        }
        // Mean normals of facets and means of children tilt the tangent plane by a few hundredths; the pairs are up
        // to 5.7 cells apart.
        const double cell = std::exp2(static_cast<double>(l));
        CHECK(worst < 0.35 * cell);
        CHECK(sum / static_cast<double>(pairs) < 0.06 * cell);
    }
}

TEST_CASE("neighbourhoods: the corner of a box unfolds to the sum of the two ways", "[pyramid][property]") {
    // The edge runs at several places through its cells: the box is moved against the grid by a second, far body.
    const double shift = GENERATE(0.0, 0.17, 0.31, 0.5, 0.77);
    CAPTURE(shift);
    TriangleMesh mesh = make_box({0, 0, 0}, {20, 20, 20});
    mesh = joined(mesh, make_box({30 - 10 + shift, -shift / 2 + 30, shift / 3 - 20}, {40, 31, -19}));
    const SurfaceVoxels shell = voxelize(mesh, {.resolution = 40});
    const VoxelPyramid pyramid = build_pyramid(shell, 1);
    const PyramidLevel& level = pyramid.levels[0];
    const double voxel = shell.grid.voxel_mm;
    const auto mm = [&](VoxelIndex v) -> const Vec3& { return shell.points_mm[v]; };
    std::size_t across = 0;
    for (VoxelIndex v = 0; v < level.size(); ++v) {
        // From the top face z = 20, in the middle of the edge x = 20, to the side.
        if (shell.components[v] != 0 || mm(v)[1] < 6 || mm(v)[1] > 14 || level.normals[v][2] < 0.999F) continue;
        if (mm(v)[2] < 20 - 1e-6 || mm(v)[0] < 10) continue;
        for (const VoxelIndex w : neighbors_of(level, v)) {
            if (level.normals[w][0] < 0.999F || mm(w)[0] < 20 - 1e-6) continue;
            ++across;
            const Vec3 expected(((20 - mm(v)[0]) + (20 - mm(w)[2])) / voxel, (mm(w)[1] - mm(v)[1]) / voxel, 0.0);
            const Vec3 offset = offset_between(level, v, w).cast<double>();
            CAPTURE(v, w, expected.transpose(), offset.transpose());
            CHECK((offset - expected).norm() < 1e-3 * expected.norm());
        }
    }
    CHECK(across > 10);
}

TEST_CASE("build_pyramid: makes as many levels as wanted or as there are", "[pyramid]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(10, 3), {.resolution = 60});
    CHECK(build_pyramid(shell, 1).levels.size() == 1);
    CHECK(build_pyramid(shell, 4).levels.size() == 4);
    // 61 cells halve to one after six steps.
    const VoxelPyramid all = build_pyramid(shell, 100);
    CHECK(all.levels.size() == 7);
    CHECK(all.levels.back().size() == 1);
    for (std::size_t l = 1; l < all.levels.size(); ++l) CHECK(all.levels[l].size() < all.levels[l - 1].size());
}

TEST_CASE("build_pyramid: gives the same pyramid on any number of threads", "[pyramid][property]") {
    for (const TriangleMesh& mesh : {make_icosphere(10, 4), make_thin_plate(9, 9, 0.1)}) {
        const SurfaceVoxels shell = voxelize(mesh, {.resolution = 80});
        VoxelPyramid reference;
        for (const int threads : {1, 2, 5}) {
            const ThreadLimit limit(threads);
            VoxelPyramid pyramid = build_pyramid(shell, 5);
            if (threads == 1) reference = pyramid;
            REQUIRE(pyramid.levels.size() == reference.levels.size());
            for (std::size_t l = 0; l < pyramid.levels.size(); ++l) {
                const PyramidLevel& a = pyramid.levels[l];
                const PyramidLevel& b = reference.levels[l];
                CHECK(a.coords == b.coords);
                CHECK(a.positions == b.positions);
                CHECK(a.normals == b.normals);
                CHECK(a.adjacency.neighbor == b.adjacency.neighbor);
                CHECK(a.parent == b.parent);
                CHECK(a.children == b.children);
                CHECK(a.neighborhoods.first == b.neighborhoods.first);
                CHECK(a.neighborhoods.count == b.neighborhoods.count);
                REQUIRE(a.neighborhoods.blocks.size() == b.neighborhoods.blocks.size());
                CHECK(std::memcmp(a.neighborhoods.blocks.data(), b.neighborhoods.blocks.data(),
                                  a.neighborhoods.blocks.size() * sizeof(NeighborBlock)) == 0);
            }
        }
    }
}

TEST_CASE("build_pyramid: rejects a number of levels below one", "[pyramid]") {
    const SurfaceVoxels shell = voxelize(make_square(1.0), {.resolution = 4});
    for (const int levels : {0, -3}) CHECK_THROWS_AS(build_pyramid(shell, levels), InvalidSetting);
}

TEST_CASE("build_pyramid: stops when asked and reports progress in order", "[pyramid]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(10, 3), {.resolution = 30});
    std::stop_source source;
    double last = -1.0;
    const RunControl run(
        [&](std::string_view, double fraction) {
            CHECK(fraction >= last);
            last = fraction;
        },
        source.get_token());
    build_pyramid(shell, 4, run);
    CHECK(last == 1.0);
    source.request_stop();
    CHECK_THROWS_AS(build_pyramid(shell, 4, run), Cancelled);
}

}  // namespace
}  // namespace fretwork
