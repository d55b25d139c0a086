#include "core/graph/connect_samples.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <map>
#include <set>

#include "core/base/disjoint_sets.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/graph/firm_links.h"
#include "core/graph/pattern_width.h"
#include "core/graph/poisson_disk.h"
#include "core/shell/voxelize.h"
#include "support/carved_shells.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::blobs;
using testing::make_icosphere;
using testing::make_linked_tori;
using testing::make_square;
using testing::make_torus;

struct Sampled {
    SurfaceVoxels shell;
    SolidStates solid;
    std::vector<VoxelIndex> samples;
};

Sampled sampled_blobs(unsigned seed) {
    Sampled s;
    const TriangleMesh mesh = seed % 3 == 0 ? make_linked_tori(20.0, 6.0) : make_icosphere(20.0, 4);
    s.shell = voxelize(mesh, {.resolution = 40});
    s.solid = blobs(s.shell, 12.0, seed);
    SampleSettings settings;
    settings.target = 80;
    settings.seed = seed;
    s.samples = poisson_samples(s.shell.adjacency, connected_components(s.shell.adjacency), s.solid, settings).voxels;
    return s;
}

TEST_CASE("connect_samples: solid edges connect what the pattern connects", "[graph][property]") {
    const auto seed = GENERATE(range(1u, 10u));
    const auto from = GENERATE(ExtendFrom::kSource, ExtendFrom::kTree);
    CAPTURE(seed);
    const Sampled s = sampled_blobs(seed);
    const AbstractGraph graph = connect_samples(s.shell.adjacency, s.solid, s.samples, from);
    const ShellComponents pieces = connected_components(s.shell.adjacency, s.solid, SolidState::kSolid);
    DisjointSets by_solid_edges(s.samples.size());
    DisjointSets by_all_edges(s.samples.size());
    for (const AbstractEdge& edge : graph.edges) {
        if (edge.state == EdgeState::kSolid) by_solid_edges.unite(edge.a, edge.b);
        by_all_edges.unite(edge.a, edge.b);
    }
    for (SampleIndex i = 0; i < s.samples.size(); ++i)
        for (SampleIndex j = i + 1; j < s.samples.size(); ++j) {
            const bool connected = pieces.of[s.samples[i]] == pieces.of[s.samples[j]];
            REQUIRE((by_solid_edges.find(i) == by_solid_edges.find(j)) == connected);
            const bool same_component = s.shell.components[s.samples[i]] == s.shell.components[s.samples[j]];
            REQUIRE((by_all_edges.find(i) == by_all_edges.find(j)) == same_component);
        }
}

TEST_CASE("connect_samples: paths are walks from sample to sample through what they claim", "[graph][property]") {
    const auto seed = GENERATE(range(1u, 7u));
    const auto from = GENERATE(ExtendFrom::kSource, ExtendFrom::kTree);
    CAPTURE(seed);
    const Sampled s = sampled_blobs(seed);
    const AbstractGraph graph = connect_samples(s.shell.adjacency, s.solid, s.samples, from);
    std::set<std::pair<SampleIndex, SampleIndex>> pairs;
    std::size_t empty_edges = 0;
    for (EdgeIndex e = 0; e < graph.edges.size(); ++e) {
        CAPTURE(e);
        const AbstractEdge& edge = graph.edges[e];
        REQUIRE(edge.a < edge.b);
        REQUIRE(pairs.emplace(edge.a, edge.b).second);
        const auto path = graph.voxel_path(e);
        REQUIRE(path.front() == s.samples[edge.a]);
        REQUIRE(path.back() == s.samples[edge.b]);
        double length = 0.0;
        std::size_t empty_voxels = 0;
        for (std::size_t k = 0; k < path.size(); ++k) {
            empty_voxels += s.solid[path[k]] == SolidState::kEmpty ? 1u : 0u;
            if (k == 0) continue;
            REQUIRE(std::ranges::binary_search(s.shell.adjacency.of(path[k - 1]), path[k]));
            Vec3 step;
            for (std::size_t axis = 0; axis < 3; ++axis)
                step[static_cast<Eigen::Index>(axis)] =
                    s.shell.coords[path[k]][axis] - s.shell.coords[path[k - 1]][axis];
            length += step.norm();
        }
        REQUIRE(static_cast<double>(edge.length_voxels) == Approx(length).epsilon(1e-4));
        if (edge.state == EdgeState::kSolid) {
            REQUIRE(empty_voxels == 0);
            REQUIRE(edge.gap_voxels == 0.0f);
        } else {
            ++empty_edges;
            REQUIRE(empty_voxels > 0);
            // One empty voxel makes two steps of the gap; each step measures between 1 and sqrt 3.
            REQUIRE(edge.gap_voxels >= static_cast<float>(empty_voxels + 1) - 1e-4f);
            REQUIRE(edge.gap_voxels <= 1.7321f * 2.0f * static_cast<float>(empty_voxels));
        }
    }
    CHECK(empty_edges > 0);
    CHECK(std::ranges::is_sorted(graph.edges, {}, [](const AbstractEdge& e) { return std::pair(e.a, e.b); }));
}

TEST_CASE("connect_samples: of all places where two trees meet, the edge takes the nearest", "[graph][property]") {
    const auto seed = GENERATE(range(1u, 5u));
    CAPTURE(seed);
    const Sampled s = sampled_blobs(seed);
    const AbstractGraph graph = connect_samples(s.shell.adjacency, s.solid, s.samples, ExtendFrom::kSource);
    // Oracle: the trees once more, and the least sum over all links between two of them.
    ForestGrower grower(s.shell.adjacency, [&] {
        std::vector<std::uint8_t> bytes;
        for (const SolidState state : s.solid) bytes.push_back(state == SolidState::kSolid ? 1 : 0);
        return bytes;
    }());
    for (std::uint32_t i = 0; i < s.samples.size(); ++i) grower.plant(s.samples[i], i);
    grower.grow();
    const ShortestPathForest& forest = grower.forest();
    std::map<std::pair<SampleIndex, SampleIndex>, double> nearest;
    for (VoxelIndex u = 0; u < s.shell.size(); ++u)
        for (std::uint32_t e = s.shell.adjacency.first[u]; e < s.shell.adjacency.first[u + 1]; ++e) {
            const VoxelIndex v = s.shell.adjacency.neighbor[e];
            if (forest.distance[u] == kUnreached || forest.distance[v] == kUnreached) continue;
            if (forest.owner[u] >= forest.owner[v]) continue;
            const double length = to_voxels(forest.distance[u]) + to_voxels(forest.distance[v]) +
                                  static_cast<double>(s.shell.adjacency.length_voxels[e]);
            const auto [at, fresh] = nearest.emplace(std::pair(forest.owner[u], forest.owner[v]), length);
            if (!fresh) at->second = std::min(at->second, length);
        }
    std::size_t solid_edges = 0;
    for (const AbstractEdge& edge : graph.edges) {
        if (edge.state == EdgeState::kEmpty) {
            REQUIRE(nearest.count({edge.a, edge.b}) == 0);
            continue;
        }
        ++solid_edges;
        REQUIRE(static_cast<double>(edge.length_voxels) == Approx(nearest.at({edge.a, edge.b})).epsilon(1e-3));
    }
    CHECK(solid_edges == nearest.size());
}

TEST_CASE("connect_samples: kTree makes the shortest gaps between stripes", "[graph]") {
    // Stripes of 6 solid and 6 empty rows on a square: every gap is 7 steps of length 1.
    const SurfaceVoxels shell = voxelize(make_square(48.0, 4), {.resolution = 48});
    SolidStates solid(shell.size());
    for (std::size_t v = 0; v < shell.size(); ++v)
        solid[v] = shell.coords[v][1] / 6 % 2 == 0 ? SolidState::kSolid : SolidState::kEmpty;
    SampleSettings settings;
    settings.target = 60;
    const auto samples =
        poisson_samples(shell.adjacency, connected_components(shell.adjacency), solid, settings).voxels;
    const AbstractGraph graph = connect_samples(shell.adjacency, solid, samples, ExtendFrom::kTree);
    float shortest = 1e9f;
    for (const AbstractEdge& edge : graph.edges)
        if (edge.state == EdgeState::kEmpty) shortest = std::min(shortest, edge.gap_voxels);
    CHECK(shortest == 7.0f);
}

TEST_CASE("connect_samples: components without a sample have no owner", "[graph]") {
    Sampled s = sampled_blobs(3);
    std::erase_if(s.samples, [&](VoxelIndex v) { return s.shell.components[v] == 1; });
    const AbstractGraph graph = connect_samples(s.shell.adjacency, s.solid, s.samples, ExtendFrom::kTree);
    for (VoxelIndex v = 0; v < s.shell.size(); ++v)
        REQUIRE((graph.owner[v] == kNoSample) == (s.shell.components[v] == 1));
}

TEST_CASE("connect_samples: does not depend on the number of threads", "[graph][determinism]") {
    const Sampled s = sampled_blobs(2);
    std::vector<VoxelIndex> reference;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        const AbstractGraph graph = connect_samples(s.shell.adjacency, s.solid, s.samples, ExtendFrom::kTree);
        if (threads == 1) reference = graph.path;
        CHECK(graph.path == reference);
    }
}

TEST_CASE("connect_samples: rejects samples that are not in order, solid and inside, and stops when asked", "[graph]") {
    const Sampled s = sampled_blobs(1);
    const auto connect = [&](std::vector<VoxelIndex> samples, const RunControl& run = {}) {
        return connect_samples(s.shell.adjacency, s.solid, std::move(samples), ExtendFrom::kTree, run);
    };
    const auto empty = static_cast<VoxelIndex>(std::ranges::find(s.solid, SolidState::kEmpty) - s.solid.begin());
    CHECK_THROWS_AS(connect({empty}), InvalidInput);
    CHECK_THROWS_AS(connect({static_cast<VoxelIndex>(s.shell.size())}), InvalidInput);
    CHECK_THROWS_AS(connect({s.samples[1], s.samples[0]}), InvalidInput);
    CHECK_THROWS_AS(connect({s.samples[1], s.samples[1]}), InvalidInput);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(connect(s.samples, RunControl(nullptr, source.get_token())), Cancelled);
}

TEST_CASE("firm_links: faces, and no component more than the shell has", "[graph][property]") {
    const auto resolution = GENERATE(9, 17, 30);
    for (const TriangleMesh& mesh : {make_icosphere(10.0, 3), make_linked_tori(20.0, 6.0), make_square(10.0)}) {
        const SurfaceVoxels shell = voxelize(mesh, {.resolution = resolution});
        const Adjacency firm = firm_links(shell.adjacency);
        CHECK(connected_components(firm).of == connected_components(shell.adjacency).of);
        const ShellComponents by_face = connected_components(face_links(shell.adjacency));
        for (VoxelIndex v = 0; v < shell.size(); ++v)
            for (std::uint32_t e = shell.adjacency.first[v]; e < shell.adjacency.first[v + 1]; ++e) {
                const VoxelIndex w = shell.adjacency.neighbor[e];
                const bool face = share_face(shell.coords[v], shell.coords[w]);
                const bool needed = by_face.of[v] != by_face.of[w];
                REQUIRE(std::ranges::binary_search(firm.of(v), w) == (face || needed));
            }
    }
}

TEST_CASE("pattern_half_width: is that of stripes", "[graph]") {
    // Stripes of `width` rows on a square. Half the width, to a quarter: the middle of an even stripe lies between
    // rows.
    const int width = GENERATE(3, 4, 7, 10);
    const SurfaceVoxels shell = voxelize(make_square(60.0, 4), {.resolution = 60});
    SolidStates solid(shell.size());
    for (std::size_t v = 0; v < shell.size(); ++v)
        solid[v] = (shell.coords[v][1] / width) % 2 == 1 ? SolidState::kSolid : SolidState::kEmpty;
    const std::vector<float> half = pattern_half_width(shell.adjacency, solid, 20.0);
    for (std::size_t v = 0; v < shell.size(); ++v) {
        if (solid[v] == SolidState::kEmpty) {
            CHECK(half[v] == 0.0f);
        } else if (shell.coords[v][1] < 60 / width * width - width) {
            CHECK(half[v] >= 0.5f * static_cast<float>(width) - 0.5f);
            CHECK(half[v] <= 0.5f * static_cast<float>(width) + 0.01f);
        }
    }
    CHECK(pattern_half_width(shell.adjacency, SolidStates(shell.size(), SolidState::kSolid), 20.0) ==
          std::vector<float>(shell.size(), 20.0f));
}

TEST_CASE("pattern_half_width: nowhere under the distance to the nearest empty voxel, and reached somewhere",
          "[graph]") {
    const SurfaceVoxels shell = voxelize(make_torus(20.0, 8.0, 48, 24), {.resolution = 48});
    const auto seed = GENERATE(range(1u, 4u));
    const SolidStates solid = blobs(shell, 12.0, seed);
    std::vector<VoxelIndex> empty;
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (solid[v] == SolidState::kEmpty) empty.push_back(v);
    const ShortestPathForest from_empty = shortest_path_forest(shell.adjacency, empty);
    const std::vector<float> half = pattern_half_width(shell.adjacency, solid, 1000.0);
    float deepest = 0.0f;
    for (std::size_t v = 0; v < shell.size(); ++v) {
        const float depth =
            solid[v] == SolidState::kEmpty ? 0.0f : static_cast<float>(to_voxels(from_empty.distance[v]) - 0.5);
        REQUIRE(half[v] >= depth);
        deepest = std::max(deepest, depth);
    }
    CHECK(std::ranges::max(half) == deepest);
}

}  // namespace
}  // namespace fretwork
