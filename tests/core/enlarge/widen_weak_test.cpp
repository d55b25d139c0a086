#include "core/enlarge/widen_weak.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/shell/voxelize.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

/// A plate of 60 voxels with a strand of `width` voxels along x.
struct Strand {
    SurfaceVoxels shell = voxelize(testing::make_square(60.0), {.resolution = 60});
    GeodesicLinks links = link_two_rings(shell);
    SolidStates solid = SolidStates(shell.size(), SolidState::kEmpty);
    std::vector<float> gain = std::vector<float>(shell.size(), 0.5F);
    Vec3 middle = Vec3::Zero();

    explicit Strand(double width) {
        for (const Vec3& p : shell.points_mm) middle += p / static_cast<double>(shell.size());
        for (std::size_t v = 0; v < shell.size(); ++v)
            if (std::abs(shell.points_mm[v].y() - middle.y()) < 0.5 * width) solid[v] = SolidState::kSolid;
    }
    void weaken(double from_x, double to_x, float by) {
        for (std::size_t v = 0; v < shell.size(); ++v) {
            const double x = shell.points_mm[v].x() - middle.x();
            if (x > from_x && x < to_x) gain[v] = by;
        }
    }
};

TEST_CASE("widen weak: a strand grows by what it lacks, where it lacks it", "[enlarge]") {
    Strand strand(8.0);
    strand.weaken(-10.0, 10.0, 1.5F);
    const std::vector<VoxelIndex> added =
        widen_weak(strand.shell, strand.links, strand.solid, strand.gain, {6.0, strand.shell.size()});
    REQUIRE_FALSE(added.empty());
    CHECK(std::ranges::is_sorted(added));
    double widest = 0.0, longest = 0.0, widest_in_middle = 0.0;
    for (const VoxelIndex v : added) {
        CHECK(strand.solid[v] == SolidState::kEmpty);
        const Vec3 d = (strand.shell.points_mm[v] - strand.middle).cwiseAbs();
        widest = std::max(widest, d.y());
        longest = std::max(longest, d.x());
        if (d.x() < 2.0) widest_in_middle = std::max(widest_in_middle, d.y());
    }
    // From a half width of 4 to 6, a voxel more or less.
    CHECK(widest_in_middle > 5.0);
    CHECK(widest < 7.5);
    CHECK(longest < 13.5);
    CHECK(longest > 9.0);
}

TEST_CASE("widen weak: thin strands grow by a voxel and a half, none by more than is allowed", "[enlarge]") {
    const auto widest_for = [](double width, float gain, double most) {
        Strand strand(width);
        strand.weaken(-10.0, 10.0, gain);
        double widest = 0.0;
        for (const VoxelIndex v :
             widen_weak(strand.shell, strand.links, strand.solid, strand.gain, {most, strand.shell.size()}))
            widest = std::max(widest, std::abs(strand.shell.points_mm[v].y() - strand.middle.y()));
        return widest;
    };
    CHECK(widest_for(4.0, 1.01F, 6.0) >= 2.5);
    CHECK(widest_for(4.0, 1.01F, 6.0) <= 4.5);
    CHECK(widest_for(20.0, 10.0F, 3.0) >= 11.5);
    CHECK(widest_for(20.0, 10.0F, 3.0) <= 14.0);
    CHECK(widest_for(20.0, 1.0F, 3.0) == 0.0);
}

TEST_CASE("widen weak: a budget goes to the weakest places", "[enlarge]") {
    Strand strand(8.0);
    strand.weaken(-25.0, -15.0, 1.2F);
    strand.weaken(15.0, 25.0, 1.4F);
    const std::vector<VoxelIndex> added = widen_weak(strand.shell, strand.links, strand.solid, strand.gain, {6.0, 10});
    CHECK(added.size() == 10);
    for (const VoxelIndex v : added) CHECK(strand.shell.points_mm[v].x() > strand.middle.x());
}

TEST_CASE("widen weak: where all is solid there is nothing to add", "[enlarge]") {
    Strand strand(200.0);
    strand.weaken(-10.0, 10.0, 3.0F);
    CHECK(widen_weak(strand.shell, strand.links, strand.solid, strand.gain, {6.0, 1000}).empty());
}

}  // namespace
}  // namespace fretwork
