#include "core/graph/poisson_disk.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/graph/shortest_path_forest.h"
#include "core/shell/voxelize.h"
#include "support/carved_shells.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::blobs;
using testing::dots;
using testing::make_icosphere;
using testing::make_linked_tori;
using testing::make_torus;

std::vector<std::uint8_t> bytes_of(const SolidStates& solid) {
    std::vector<std::uint8_t> bytes;
    for (const SolidState s : solid) bytes.push_back(s == SolidState::kSolid ? 1 : 0);
    return bytes;
}

/// No two samples within r of each other, no solid voxel farther than r from all of them.
void check_poisson_property(const SurfaceVoxels& shell, const ShellComponents& components, const SolidStates& solid,
                            const Samples& samples) {
    const std::vector<std::uint8_t> included = bytes_of(solid);
    const ShortestPathForest cover = shortest_path_forest(shell.adjacency, samples.voxels, included);
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (solid[v] == SolidState::kSolid)
            REQUIRE(cover.distance[v] <= to_distance(samples.radius_voxels[components.of[v]]));
    for (std::size_t i = 0; i < samples.voxels.size(); ++i) {
        const std::vector<VoxelIndex> one{samples.voxels[i]};
        const double radius = samples.radius_voxels[components.of[one[0]]];
        const ShortestPathForest around = shortest_path_forest(shell.adjacency, one, included, to_distance(radius));
        for (std::size_t j = 0; j < samples.voxels.size(); ++j)
            if (i != j) REQUIRE(around.distance[samples.voxels[j]] == kUnreached);
    }
}

TEST_CASE("poisson_samples: samples keep the radius and cover the pattern", "[graph][property]") {
    const auto seed = GENERATE(range(1u, 7u));
    CAPTURE(seed);
    const SurfaceVoxels shell = voxelize(make_torus(20.0, 8.0, 48, 24), {.resolution = 48});
    const ShellComponents components = connected_components(shell.adjacency);
    const SolidStates solid = blobs(shell, 14.0, seed);
    SampleSettings settings;
    settings.target = 120;
    settings.seed = seed;
    const Samples samples = poisson_samples(shell.adjacency, components, solid, settings);
    check_poisson_property(shell, components, solid, samples);
    CHECK(std::ranges::is_sorted(samples.voxels));
    // Bisection stops at 5 % of the target, or at an interval of 2 % of the radius: 4 % of the count, plus chance.
    CHECK(samples.voxels.size() >= 105);
    CHECK(samples.voxels.size() <= 135);
}

TEST_CASE("poisson_samples: a radius to start from is kept where it does, and left where it does not", "[graph]") {
    const SurfaceVoxels shell = voxelize(make_torus(20.0, 8.0, 48, 24), {.resolution = 48});
    const SolidStates solid(shell.size(), SolidState::kSolid);
    const ShellComponents components = connected_components(shell.adjacency);
    SampleSettings settings;
    settings.target = 200;
    const double found = poisson_samples(shell.adjacency, components, solid, settings).radius_voxels[0];
    settings.start_radius_voxels = {1.02 * found};
    CHECK(poisson_samples(shell.adjacency, components, solid, settings).radius_voxels[0] == 1.02 * found);
    settings.start_radius_voxels = {2.0 * found};
    const Samples samples = poisson_samples(shell.adjacency, components, solid, settings);
    CHECK(samples.voxels.size() >= 180);
    CHECK(samples.voxels.size() <= 220);
}

TEST_CASE("poisson_samples: every piece of the pattern gets a sample, also when there are too many", "[graph]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(20.0, 4), {.resolution = 64});
    const ShellComponents components = connected_components(shell.adjacency);
    const SolidStates solid = dots(shell, 8.0, 2.5);
    const ShellComponents pieces = connected_components(shell.adjacency, solid, SolidState::kSolid);
    REQUIRE(pieces.count() > 100);
    SampleSettings settings;
    settings.target = 50;
    const Samples samples = poisson_samples(shell.adjacency, components, solid, settings);
    std::set<std::uint32_t> sampled;
    for (const VoxelIndex v : samples.voxels) sampled.insert(pieces.of[v]);
    CHECK(sampled.size() == pieces.count());
    CHECK(samples.voxels.size() == pieces.count());
}

TEST_CASE("poisson_samples: components of the shell share the samples by their solid voxels", "[graph]") {
    const SurfaceVoxels shell = voxelize(make_linked_tori(20.0, 6.0), {.resolution = 64});
    const ShellComponents components = connected_components(shell.adjacency);
    REQUIRE(components.count() == 2);
    SolidStates solid(shell.size(), SolidState::kSolid);
    // A tenth of the second torus.
    std::size_t kept = 0;
    for (VoxelIndex v = 0; v < shell.size(); ++v)
        if (components.of[v] == 1 && kept++ > components.sizes[1] / 10) solid[v] = SolidState::kEmpty;
    SampleSettings settings;
    settings.target = 220;
    settings.least = 24;
    const Samples samples = poisson_samples(shell.adjacency, components, solid, settings);
    std::vector<std::size_t> count(2, 0);
    for (const VoxelIndex v : samples.voxels) ++count[components.of[v]];
    CHECK(count[0] == Approx(200).epsilon(0.15));
    CHECK(count[1] == Approx(24).epsilon(0.3));
    check_poisson_property(shell, components, solid, samples);
}

TEST_CASE("poisson_samples: small patterns give all they have", "[graph]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(5.0, 2), {.resolution = 12});
    const ShellComponents components = connected_components(shell.adjacency);
    SolidStates solid(shell.size(), SolidState::kEmpty);
    CHECK(poisson_samples(shell.adjacency, components, solid, {}).voxels.empty());
    solid[7] = SolidState::kSolid;
    CHECK(poisson_samples(shell.adjacency, components, solid, {}).voxels == std::vector<VoxelIndex>{7});
    std::ranges::fill(solid, SolidState::kSolid);
    CHECK(poisson_samples(shell.adjacency, components, solid, {}).voxels.size() == shell.size());
}

TEST_CASE("poisson_samples: the seed alone decides, not the threads", "[graph][determinism]") {
    const SurfaceVoxels shell = voxelize(make_torus(20.0, 8.0, 48, 24), {.resolution = 48});
    const ShellComponents components = connected_components(shell.adjacency);
    const SolidStates solid = blobs(shell, 14.0, 5);
    SampleSettings settings;
    settings.target = 100;
    std::vector<VoxelIndex> reference;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        const Samples samples = poisson_samples(shell.adjacency, components, solid, settings);
        if (threads == 1) reference = samples.voxels;
        CHECK(samples.voxels == reference);
    }
    settings.seed = 2;
    CHECK(poisson_samples(shell.adjacency, components, solid, settings).voxels != reference);
}

TEST_CASE("poisson_samples: rejects a target of nothing, and stops when asked", "[graph]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(10.0, 3), {.resolution = 32});
    const ShellComponents components = connected_components(shell.adjacency);
    const SolidStates solid(shell.size(), SolidState::kSolid);
    SampleSettings settings;
    settings.target = 0;
    CHECK_THROWS_AS(poisson_samples(shell.adjacency, components, solid, settings), InvalidSetting);
    std::stop_source source;
    source.request_stop();
    const RunControl run(nullptr, source.get_token());
    CHECK_THROWS_AS(poisson_samples(shell.adjacency, components, solid, {}, run), Cancelled);
}

}  // namespace
}  // namespace fretwork
