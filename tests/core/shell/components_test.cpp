#include "core/shell/components.h"

#include <catch2/catch.hpp>
#include <vector>

#include "core/shell/voxelize.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using namespace testing;

TEST_CASE("connected_components: of one state alone, with sizes", "[shell]") {
    // Rows of a square, every third one empty: solid stripes of two rows.
    const SurfaceVoxels shell = voxelize(make_square(16.0), {.resolution = 16});
    SolidStates states(shell.size());
    for (std::size_t v = 0; v < shell.size(); ++v)
        states[v] = shell.coords[v][1] % 3 == 2 ? SolidState::kEmpty : SolidState::kSolid;
    const ShellComponents solid = connected_components(shell.adjacency, states, SolidState::kSolid);
    CHECK(solid.sizes == std::vector<std::size_t>(6, 34));  // 17 rows: 5 are empty
    for (std::size_t v = 0; v < shell.size(); ++v)
        CHECK(solid.of[v] ==
              (states[v] == SolidState::kEmpty ? kNoComponent : static_cast<std::uint32_t>(shell.coords[v][1] / 3)));
    CHECK(connected_components(shell.adjacency, states, SolidState::kEmpty).sizes == std::vector<std::size_t>(5, 17));
}

TEST_CASE("face_links: keeps the links over faces and no others", "[shell]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(10, 3), {.resolution = 24});
    const Adjacency faces = face_links(shell.adjacency);
    REQUIRE(faces.first.size() == shell.adjacency.first.size());
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        std::vector<VoxelIndex> expected;
        for (const VoxelIndex w : shell.adjacency.of(v))
            if (share_face(shell.coords[v], shell.coords[w])) expected.push_back(w);
        CHECK(std::vector<VoxelIndex>(faces.of(v).begin(), faces.of(v).end()) == expected);
    }
}

}  // namespace
}  // namespace fretwork
