#include "core/graph/shortest_path_forest.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <tuple>

#include "core/shell/voxelize.h"
#include "support/carved_shells.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::dust;
using testing::make_icosphere;

struct Entry {
    GraphDistance distance = kUnreached;
    std::uint32_t owner = 0;
};

/// Bellman and Ford: relax all links until nothing changes, by (distance, owner).
std::vector<Entry> brute_force(const Adjacency& graph, const std::vector<VoxelIndex>& sources,
                               const std::vector<std::uint8_t>& included) {
    std::vector<Entry> best(graph.first.size() - 1);
    for (std::uint32_t i = 0; i < sources.size(); ++i)
        if (best[sources[i]].distance == kUnreached) best[sources[i]] = {0, i};
    for (bool changed = true; changed;) {
        changed = false;
        for (VoxelIndex v = 0; v < best.size(); ++v) {
            if (best[v].distance == kUnreached) continue;
            for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
                const VoxelIndex w = graph.neighbor[e];
                if (!included.empty() && included[w] == 0) continue;
                const GraphDistance d = best[v].distance + to_distance(graph.length_voxels[e]);
                if (std::tie(d, best[v].owner) >= std::tie(best[w].distance, best[w].owner)) continue;
                best[w] = {d, best[v].owner};
                changed = true;
            }
        }
    }
    return best;
}

/// Lowest neighbour over which a vertex has its distance and owner.
VoxelIndex lowest_parent(const Adjacency& graph, const ShortestPathForest& forest, VoxelIndex v) {
    for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
        const VoxelIndex w = graph.neighbor[e];
        if (forest.distance[w] != kUnreached && forest.owner[w] == forest.owner[v] &&
            forest.distance[w] + to_distance(graph.length_voxels[e]) == forest.distance[v])
            return w;
    }
    return kNoVoxel;
}

struct RandomCase {
    SurfaceVoxels shell;
    std::vector<std::uint8_t> included;
    std::vector<VoxelIndex> sources;
};

RandomCase random_case(unsigned seed) {
    std::mt19937 rng{seed};
    RandomCase c;
    c.shell = voxelize(make_icosphere(10.0, 3), {.resolution = 14 + static_cast<int>(seed % 5)});
    const SolidStates solid = dust(c.shell, 0.55, seed);
    for (const SolidState s : solid) c.included.push_back(s == SolidState::kSolid ? 1 : 0);
    std::uniform_int_distribution<VoxelIndex> any(0, static_cast<VoxelIndex>(c.shell.size() - 1));
    while (c.sources.size() < 9) {
        const VoxelIndex v = any(rng);
        if (c.included[v] != 0 && std::ranges::find(c.sources, v) == c.sources.end()) c.sources.push_back(v);
    }
    return c;
}

TEST_CASE("shortest_path_forest: distances, owners and parents are those of brute force", "[graph][property]") {
    const auto seed = GENERATE(range(1u, 13u));
    CAPTURE(seed);
    const RandomCase c = random_case(seed);
    const bool restricted = seed % 2 == 0;
    const std::vector<std::uint8_t> included = restricted ? c.included : std::vector<std::uint8_t>{};
    const ShortestPathForest forest = shortest_path_forest(c.shell.adjacency, c.sources, included);
    const std::vector<Entry> expected = brute_force(c.shell.adjacency, c.sources, included);
    std::size_t reached = 0;
    for (VoxelIndex v = 0; v < c.shell.size(); ++v) {
        CAPTURE(v);
        REQUIRE(forest.distance[v] == expected[v].distance);
        if (forest.distance[v] == kUnreached) {
            REQUIRE(forest.parent[v] == kNoVoxel);
            continue;
        }
        ++reached;
        REQUIRE(forest.owner[v] == expected[v].owner);
        const bool source = forest.distance[v] == 0;
        REQUIRE(forest.parent[v] == (source ? v : lowest_parent(c.shell.adjacency, forest, v)));
    }
    CHECK(reached > c.sources.size());
}

TEST_CASE("ForestGrower: sources planted one at a time give the forest of all at once", "[graph][property]") {
    const auto seed = GENERATE(range(1u, 9u));
    CAPTURE(seed);
    const RandomCase c = random_case(seed);
    const ShortestPathForest together = shortest_path_forest(c.shell.adjacency, c.sources);
    ForestGrower grower(c.shell.adjacency);
    // Last owners first: every later one takes over what it is nearer to, and ties.
    for (std::uint32_t i = static_cast<std::uint32_t>(c.sources.size()); i-- > 0;) {
        grower.plant(c.sources[i], i);
        grower.grow();
    }
    CHECK(grower.forest().distance == together.distance);
    CHECK(grower.forest().owner == together.owner);
    CHECK(grower.forest().parent == together.parent);
}

TEST_CASE("ForestGrower: a limit cuts the forest at that distance", "[graph]") {
    const RandomCase c = random_case(3);
    const ShortestPathForest whole = shortest_path_forest(c.shell.adjacency, c.sources);
    const GraphDistance limit = to_distance(3.0);
    const ShortestPathForest part = shortest_path_forest(c.shell.adjacency, c.sources, {}, limit);
    for (VoxelIndex v = 0; v < c.shell.size(); ++v)
        CHECK(part.distance[v] == (whole.distance[v] <= limit ? whole.distance[v] : kUnreached));
}

TEST_CASE("ForestGrower: extension keeps the trees and reaches everything", "[graph][property]") {
    const auto from = GENERATE(ExtendFrom::kSource, ExtendFrom::kTree);
    const RandomCase c = random_case(4);
    ForestGrower grower(c.shell.adjacency, c.included);
    for (std::uint32_t i = 0; i < c.sources.size(); ++i) grower.plant(c.sources[i], i);
    grower.grow();
    const ShortestPathForest before = grower.forest();
    grower.extend_to_all(from);
    grower.grow();
    const ShortestPathForest& after = grower.forest();

    // Oracle: every voxel of a tree is a source of its own with a head start.
    std::vector<std::uint64_t> expected(c.shell.size(), kUnreached);
    for (VoxelIndex v = 0; v < c.shell.size(); ++v)
        if (before.distance[v] != kUnreached) expected[v] = from == ExtendFrom::kTree ? 0 : before.distance[v];
    const std::vector<std::uint64_t> start = expected;
    for (bool changed = true; changed;) {
        changed = false;
        for (VoxelIndex v = 0; v < c.shell.size(); ++v)
            for (std::uint32_t e = c.shell.adjacency.first[v]; e < c.shell.adjacency.first[v + 1]; ++e) {
                const VoxelIndex w = c.shell.adjacency.neighbor[e];
                const std::uint64_t d = expected[v] + to_distance(c.shell.adjacency.length_voxels[e]);
                if (expected[v] == kUnreached || start[w] != kUnreached || d >= expected[w]) continue;
                expected[w] = d;
                changed = true;
            }
    }
    for (VoxelIndex v = 0; v < c.shell.size(); ++v) {
        CAPTURE(v);
        REQUIRE(after.distance[v] == expected[v]);
        if (before.distance[v] == kUnreached) continue;
        REQUIRE(after.owner[v] == before.owner[v]);
        REQUIRE(after.parent[v] == before.parent[v]);
    }
}

TEST_CASE("shortest_path_forest: fixed-point lengths are within 1e-4 of Euclid's", "[graph]") {
    for (const double length : {1.0, std::sqrt(2.0), std::sqrt(3.0)})
        CHECK(std::abs(to_voxels(to_distance(length)) / length - 1.0) < 1e-4);
}

TEST_CASE("path_to_source: follows parents to the source and ends there", "[graph]") {
    const RandomCase c = random_case(5);
    const ShortestPathForest forest = shortest_path_forest(c.shell.adjacency, c.sources, c.included);
    for (VoxelIndex v = 0; v < c.shell.size(); ++v) {
        const std::vector<VoxelIndex> path = path_to_source(forest, v);
        if (forest.distance[v] == kUnreached) {
            CHECK(path.empty());
            continue;
        }
        REQUIRE(path.front() == v);
        REQUIRE(path.back() == c.sources[forest.owner[v]]);
        for (std::size_t k = 1; k < path.size(); ++k)
            REQUIRE(std::ranges::binary_search(c.shell.adjacency.of(path[k - 1]), path[k]));
    }
}

}  // namespace
}  // namespace fretwork
