// Scores of edges on the voxels of the shell.
#include <catch2/catch.hpp>

#include "core/pipeline/shell_stress.h"

namespace fretwork {
namespace {

/// Voxels in a row, each a neighbour of the next.
SurfaceVoxels row_of(std::uint32_t count) {
    SurfaceVoxels shell;
    shell.adjacency.first.push_back(0);
    for (std::uint32_t v = 0; v < count; ++v) {
        shell.coords.push_back({static_cast<std::int32_t>(v), 0, 0});
        if (v > 0) shell.adjacency.neighbor.push_back(v - 1);
        if (v + 1 < count) shell.adjacency.neighbor.push_back(v + 1);
        shell.adjacency.first.push_back(static_cast<std::uint32_t>(shell.adjacency.neighbor.size()));
    }
    return shell;
}

TEST_CASE("stress on voxels: the highest of the paths, then the nearest path, nothing beyond a gap",
          "[pipeline][report]") {
    const SurfaceVoxels shell = row_of(10);
    SolidStates solid(10, SolidState::kSolid);
    solid[7] = SolidState::kEmpty;
    // Two edges that meet in voxel 2.
    ScoredPaths scored;
    scored.scores_pa = {3e6, 1e6};
    scored.voxels = {1, 2, 2, 3};
    scored.first = {0, 2, 4};
    const StressField field = stress_on_voxels(shell, solid, scored);
    CHECK(field.voxel_mpa == std::vector<float>{3, 3, 3, 1, 1, 1, 1, -1, -1, -1});
    CHECK(field.samples_mpa == std::vector<double>{1.0, 3.0});
    CHECK(stress_on_voxels(shell, solid, {}).voxel_mpa == std::vector<float>(10, -1.0F));
    CHECK(stress_on_voxels(shell, solid, {}).samples_mpa.empty());
}

}  // namespace
}  // namespace fretwork
