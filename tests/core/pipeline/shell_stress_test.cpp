// Scores of edges on the voxels of the shell.
#include <catch2/catch.hpp>
#include <cmath>

#include "core/pipeline/label_patches.h"
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

TEST_CASE("label patches: one number while the picture goes on, over its border too; another behind a seam or a turn",
          "[pipeline][report]") {
    SurfaceVoxels shell = row_of(12);
    shell.grid.voxel_mm = 0.5;
    for (int v = 0; v < 12; ++v) shell.points_mm.emplace_back(0.5 * v, 0.0, 0.0);
    Exemplar exemplar;
    exemplar.width = 8;
    exemplar.height = 8;
    TexelFrames frames(12);
    for (std::size_t v = 0; v < 12; ++v) {
        // Two pixels a voxel, around the picture more than once; half a pixel and more off from voxel 5 on.
        const float shift = v >= 5 ? 0.6F : 0.4F * static_cast<float>(v >= 3);
        frames[v] = {std::fmod(2.0F * static_cast<float>(v) + shift, 8.0F), 3.0F, {2, 0, 0}, {0, 2, 0}};
        if (v >= 5) frames[v].v = 6.0F;
        if (v >= 9) frames[v].dv = {0, 0, 2};
    }
    CHECK(label_patches(shell, frames, exemplar) == std::vector<std::uint16_t>{1, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3});
    for (std::size_t v = 5; v < 9; ++v) frames[v].v = 3.0F;  // only 0.2 pixels off now
    CHECK(label_patches(shell, frames, exemplar) == std::vector<std::uint16_t>{1, 1, 1, 1, 1, 1, 1, 1, 1, 2, 2, 2});
    for (std::size_t v = 5; v < 9; ++v) frames[v].u = std::fmod(frames[v].u + 0.6F, 8.0F);  // 0.8
    CHECK(label_patches(shell, frames, exemplar) == std::vector<std::uint16_t>{1, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3});
}

}  // namespace
}  // namespace fretwork
