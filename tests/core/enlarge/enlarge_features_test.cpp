#include "core/enlarge/enlarge_features.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/enlarge/geodesic_links.h"
#include "core/enlarge/settle_widths.h"
#include "core/shell/voxelize.h"
#include "support/make_meshes.h"

namespace fretwork {
namespace {

using testing::make_icosphere;
using testing::make_square;

using Distance = std::function<double(const Vec3&, const Vec3&)>;

double flat(const Vec3& a, const Vec3& b) {
    return (a - b).norm();
}

Distance on_sphere(double radius_mm) {
    return [radius_mm](const Vec3& a, const Vec3& b) {
        return 2.0 * radius_mm * std::asin(std::min(1.0, 0.5 * (a.normalized() - b.normalized()).norm()));
    };
}

/// With links made for the call.
EnlargeResult enlarge(const SurfaceVoxels& shell, const SolidStates& solid, const std::vector<std::uint8_t>& protect,
                      const EnlargeSettings& settings, const RunControl& run = {}) {
    return enlarge_features(shell, link_two_rings(shell), solid, protect, settings, run);
}

SolidStates paint(const SurfaceVoxels& shell, const std::function<bool(const Vec3&)>& solid) {
    SolidStates states(shell.size());
    for (std::size_t v = 0; v < shell.size(); ++v)
        states[v] = solid(shell.points_mm[v]) ? SolidState::kSolid : SolidState::kEmpty;
    return states;
}

/// A few cosine waves in random directions: blobs, threads and specks of every width.
std::function<bool(const Vec3&)> random_blobs(std::uint64_t seed, double wavelength_mm) {
    struct Wave {
        Vec3 k;
        double phase;
    };
    std::vector<Wave> waves;
    for (std::uint64_t i = 0; i < 12; ++i) {
        const auto draw = [&](std::uint32_t n) {
            return unit_interval(counter_random(seed, RandomStream::kTest, 0, i, n));
        };
        const Vec3 direction = Vec3(draw(0) - 0.5, draw(1) - 0.5, draw(2) - 0.5).normalized();
        waves.push_back({direction * (2.0 * std::numbers::pi / (wavelength_mm * (0.5 + draw(3)))), 7.0 * draw(4)});
    }
    return [waves](const Vec3& p) {
        double sum = 0.0;
        for (const Wave& w : waves) sum += std::cos(w.k.dot(p) + w.phase);
        return sum < 0.3;
    };
}

/// Independent judge: no Dijkstra, no adjacency. Counts the voxels of one state that lie in no disc of that state:
/// a disc of diameter width less one voxel, reached with half a voxel to spare.
std::size_t outside_every_disc(const SurfaceVoxels& shell, const SolidStates& states, SolidState which, double width_mm,
                               const Distance& distance) {
    const double voxel = shell.grid.voxel_mm, radius = 0.5 * (width_mm - voxel);
    std::vector<std::uint8_t> center(shell.size(), 1);
    for (std::size_t c = 0; c < shell.size(); ++c)
        for (std::size_t v = 0; v < shell.size() && center[c] != 0; ++v)
            if (states[v] != which && distance(shell.points_mm[c], shell.points_mm[v]) < radius) center[c] = 0;
    std::size_t alone = 0;
    for (std::size_t v = 0; v < shell.size(); ++v) {
        if (states[v] != which) continue;
        bool covered = false;
        for (std::size_t c = 0; c < shell.size() && !covered; ++c)
            covered = center[c] != 0 && distance(shell.points_mm[c], shell.points_mm[v]) <= 0.5 * (width_mm + voxel);
        if (!covered) ++alone;
    }
    return alone;
}

/// Components over voxels that share a face and are neighbours on the surface.
std::size_t count_pieces(const SurfaceVoxels& shell, const SolidStates& states) {
    std::vector<std::uint8_t> seen(shell.size(), 0);
    std::size_t pieces = 0;
    for (VoxelIndex seed = 0; seed < shell.size(); ++seed) {
        if (seen[seed] != 0 || states[seed] == SolidState::kEmpty) continue;
        ++pieces;
        std::vector<VoxelIndex> stack(1, seed);
        seen[seed] = 1;
        while (!stack.empty()) {
            const VoxelIndex v = stack.back();
            stack.pop_back();
            for (const VoxelIndex u : shell.adjacency.of(v)) {
                int steps = 0;
                for (std::size_t k = 0; k < 3; ++k) steps += std::abs(shell.coords[u][k] - shell.coords[v][k]);
                if (steps != 1 || seen[u] != 0 || states[u] == SolidState::kEmpty) continue;
                seen[u] = 1;
                stack.push_back(u);
            }
        }
    }
    return pieces;
}

void check_promises(const SurfaceVoxels& shell, const EnlargeResult& result, const EnlargeSettings& settings,
                    const Distance& distance) {
    CHECK(outside_every_disc(shell, result.solid, SolidState::kSolid, settings.min_feature_mm, distance) == 0);
    CHECK(outside_every_disc(shell, result.solid, SolidState::kEmpty, settings.min_hole_mm, distance) == 0);
    const std::size_t shells = 1 + *std::max_element(shell.components.begin(), shell.components.end());
    CHECK(count_pieces(shell, result.solid) == shells);
    CHECK(result.components == shells);
}

TEST_CASE("geodesic links: distances on a plate are those of the plane to 3 percent", "[enlarge]") {
    const SurfaceVoxels shell = voxelize(make_square(30.0), {.resolution = 30});
    const GeodesicLinks links = link_two_rings(shell);
    VoxelMask source(shell.size(), 0);
    const VoxelIndex start = static_cast<VoxelIndex>(shell.size() / 3);
    source[start] = 1;
    const std::vector<float> distance = geodesic_distance(links, source, 12.0);
    for (std::size_t v = 0; v < shell.size(); ++v) {
        const double truth = (shell.points_mm[v] - shell.points_mm[start]).norm() / shell.grid.voxel_mm;
        CAPTURE(v, truth);
        if (truth <= 11.5) {
            CHECK(static_cast<double>(distance[v]) >= truth * (1.0 - 1e-5));
            CHECK(static_cast<double>(distance[v]) <= truth * 1.03 + 1e-5);
        }
        if (truth > 12.0) CHECK(distance[v] == kBeyondReach);
    }
}

TEST_CASE("geodesic links: those of each voxel are its neighbours and theirs, also where sheets share cells",
          "[enlarge]") {
    // The two faces of the plate are closer than a voxel.
    const bool thin = GENERATE(false, true);
    const SurfaceVoxels shell =
        voxelize(thin ? testing::make_thin_plate(30.0, 24.0, 0.4) : make_icosphere(10.0, 3), {.resolution = 24});
    const GeodesicLinks links = link_two_rings(shell);
    REQUIRE(links.size() == shell.size());
    for (VoxelIndex v = 0; v < shell.size(); ++v) {
        std::set<VoxelIndex> ring;
        for (const VoxelIndex a : shell.adjacency.of(v)) {
            ring.insert(a);
            for (const VoxelIndex b : shell.adjacency.of(a)) ring.insert(b);
        }
        ring.erase(v);
        const auto begin = links.neighbor.begin() + links.first[v], end = links.neighbor.begin() + links.first[v + 1];
        REQUIRE(std::equal(begin, end, ring.begin(), ring.end()));
    }
}

TEST_CASE("geodesic links: distances are the least sums of lengths, bit by bit, for any number of threads",
          "[enlarge]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(20.0, 4), {.resolution = 60});
    const GeodesicLinks links = link_two_rings(shell);
    VoxelMask sources(shell.size(), 0);
    for (std::size_t v = 0; v < shell.size(); v += 701) sources[v] = 1;
    const double reach = GENERATE(0.3, 2.5, 9.0);
    // The plainest way to the same sums: step until nothing changes.
    std::vector<float> least(shell.size(), kBeyondReach);
    for (std::size_t v = 0; v < shell.size(); ++v)
        if (sources[v] != 0) least[v] = 0.0F;
    for (bool changed = true; changed;) {
        changed = false;
        for (std::size_t v = 0; v < shell.size(); ++v)
            for (std::uint32_t k = links.first[v]; k < links.first[v + 1]; ++k) {
                const float next = least[v] + links.length_voxels[k];
                if (next > static_cast<float>(reach) || next >= least[links.neighbor[k]]) continue;
                least[links.neighbor[k]] = next;
                changed = true;
            }
    }
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        CHECK(geodesic_distance(links, sources, reach) == least);
    }
}

TEST_CASE("enlarge: threads of one voxel on a plate become as wide as asked, no more", "[enlarge]") {
    const SurfaceVoxels shell = voxelize(make_square(40.0), {.resolution = 40});
    const double voxel = shell.grid.voxel_mm;
    // A cross of two threads: one piece already.
    const SolidStates cross = paint(shell, [&](const Vec3& p) {
        return std::abs(p.x() - 20.0) < 0.6 * voxel || std::abs(p.y() - 20.0) < 0.6 * voxel;
    });
    const double width = GENERATE(3.0, 5.0, 8.0);
    CAPTURE(width);
    const EnlargeSettings settings{.min_feature_mm = width * voxel, .min_hole_mm = 3.0 * voxel};
    const EnlargeResult result = enlarge(shell, cross, {}, settings);
    check_promises(shell, result, settings, flat);
    for (std::size_t v = 0; v < shell.size(); ++v) {
        const Vec3& p = shell.points_mm[v];
        // Away from the centre's rounded corners and from the cut ends.
        if (std::abs(p.x() - 20.0) < width * voxel || p.y() < width || p.y() > 40.0 - width) continue;
        if (std::abs(p.x() - 20.0) > 12.0) continue;
        const double from_thread = std::abs(p.y() - 20.0);
        CAPTURE(p.x(), p.y());
        if (from_thread < 0.5 * (width - 1.0) * voxel) CHECK(result.solid[v] == SolidState::kSolid);
        if (from_thread > 0.5 * (width + 1.0) * voxel + 0.6 * voxel) CHECK(result.solid[v] == SolidState::kEmpty);
    }
}

TEST_CASE("enlarge: a pattern that is good already stays as it is", "[enlarge]") {
    const SurfaceVoxels shell = voxelize(make_square(60.0), {.resolution = 60});
    const SolidStates holes = paint(shell, [&](const Vec3& p) {
        const double x = std::remainder(p.x(), 20.0), y = std::remainder(p.y(), 20.0);
        return std::hypot(x, y) > 5.4;
    });
    const EnlargeResult result = enlarge(shell, holes, {}, {.min_feature_mm = 4.0, .min_hole_mm = 4.0});
    CHECK(result.solid == holes);
    CHECK(result.voxels_enlarged == 0);
    CHECK(result.voxels_filled == 0);
    CHECK(result.islands_dropped == 0);
    CHECK(result.islands_joined == 0);
}

TEST_CASE("enlarge: slits narrower than the least hole close, wider ones stay", "[enlarge]") {
    const SurfaceVoxels shell = voxelize(make_square(40.0), {.resolution = 40});
    const double voxel = shell.grid.voxel_mm;
    const SolidStates slits = paint(shell, [&](const Vec3& p) {
        const bool within = p.y() > 8.0 && p.y() < 32.0;
        const bool narrow = std::abs(p.x() - 10.0) < 0.9 * voxel, wide = std::abs(p.x() - 28.0) < 3.6 * voxel;
        return !(within && (narrow || wide));
    });
    const EnlargeResult result = enlarge(shell, slits, {}, {.min_feature_mm = 4.0 * voxel, .min_hole_mm = 4.0 * voxel});
    std::size_t narrow_left = 0, wide_left = 0;
    for (std::size_t v = 0; v < shell.size(); ++v)
        if (result.solid[v] == SolidState::kEmpty) ++(shell.points_mm[v].x() < 19.0 ? narrow_left : wide_left);
    CHECK(narrow_left == 0);
    CHECK(wide_left > 100);
    CHECK(result.voxels_filled > 0);
}

TEST_CASE("enlarge: keeps every promise on random patterns", "[enlarge][property]") {
    const auto seed = GENERATE(1u, 2u, 3u);
    const double feature = GENERATE(2.5, 4.5);
    CAPTURE(seed, feature);
    SECTION("on a plate") {
        const SurfaceVoxels shell = voxelize(make_square(36.0), {.resolution = 36});
        const EnlargeSettings settings{.min_feature_mm = feature, .min_hole_mm = 3.0};
        check_promises(shell, enlarge(shell, paint(shell, random_blobs(seed, 9.0)), {}, settings), settings, flat);
    }
    SECTION("on a sphere") {
        const double radius = 10.0;
        const SurfaceVoxels shell = voxelize(make_icosphere(radius, 4), {.resolution = 24});
        const EnlargeSettings settings{.min_feature_mm = feature, .min_hole_mm = 3.0};
        check_promises(shell, enlarge(shell, paint(shell, random_blobs(seed, 9.0)), {}, settings), settings,
                       on_sphere(radius));
    }
}

TEST_CASE("enlarge: what has settled around changes has settled everywhere", "[enlarge][property]") {
    const std::uint64_t seed = GENERATE(1, 2, 3, 4);
    const double wavelength_mm = GENERATE(1.5, 4.0);
    const SurfaceVoxels shell = voxelize(make_icosphere(10.0, 4), {.resolution = 80});
    const GeodesicLinks links = link_two_rings(shell);
    const SolidStates start = paint(shell, random_blobs(seed, wavelength_mm));
    VoxelMask solid(shell.size()), may_fill(shell.size());
    for (std::size_t v = 0; v < shell.size(); ++v) {
        solid[v] = start[v] == SolidState::kSolid ? 1 : 0;
        may_fill[v] = 1 - solid[v];
    }
    constexpr double kFeature = 4.5, kHole = 5.0;  // voxels
    const SettleCounts first = settle_widths(shell, links, solid, may_fill, kFeature, kHole, {});
    CHECK(first.enlarged > 0);
    CHECK(first.filled > 0);
    CHECK(first.components == 1);
    // The first round of another call looks at the whole shell.
    const VoxelMask settled = solid;
    const SettleCounts again = settle_widths(shell, links, solid, may_fill, kFeature, kHole, {});
    CHECK(again.enlarged == 0);
    CHECK(again.filled == 0);
    CHECK(again.joined == 0);
    CHECK(again.components == 1);
    CHECK(solid == settled);
}

TEST_CASE("enlarge: drops specks, joins islands, counts both", "[enlarge]") {
    const SurfaceVoxels shell = voxelize(make_square(40.0), {.resolution = 40});
    const SolidStates states = paint(shell, [](const Vec3& p) {
        const bool left = p.x()<12.0, right = p.x()> 28.0;
        const bool speck = std::abs(p.x() - 20.0) < 0.6 && std::abs(p.y() - 20.0) < 0.6;
        return left || right || speck;
    });
    const EnlargeResult result = enlarge(shell, states, {}, {.min_feature_mm = 4.0, .min_hole_mm = 4.0});
    CHECK(result.islands_dropped == 1);
    CHECK(result.islands_joined == 1);
    CHECK(result.components == 1);
    CHECK(count_pieces(shell, result.solid) == 1);
}

TEST_CASE("enlarge: two parts of an object each get one piece, also where the pattern left none", "[enlarge]") {
    const TriangleMesh two =
        testing::joined(make_icosphere(8.0, 3), testing::translated(make_icosphere(8.0, 3), Vec3(20.0, 0.0, 0.0)));
    const SurfaceVoxels shell = voxelize(two, {.resolution = 40});
    const SolidStates left_only =
        paint(shell, [](const Vec3& p) { return p.x() < 10.0 && std::sin(2.0 * p.z()) > 0.0; });
    const EnlargeResult result = enlarge(shell, left_only, {}, {.min_feature_mm = 2.0, .min_hole_mm = 2.0});
    CHECK(result.components == 2);
    CHECK(count_pieces(shell, result.solid) == 2);
}

TEST_CASE("enlarge: protected voxels keep their state", "[enlarge][property]") {
    const auto seed = GENERATE(range(1u, 4u));
    const SurfaceVoxels shell = voxelize(make_square(30.0), {.resolution = 30});
    const SolidStates states = paint(shell, random_blobs(seed, 7.0));
    std::vector<std::uint8_t> protect(shell.size(), 0);
    for (std::size_t v = 0; v < shell.size(); ++v) protect[v] = shell.points_mm[v].x() < 12.0 ? 1 : 0;
    const EnlargeResult result = enlarge(shell, states, protect, {.min_feature_mm = 4.0, .min_hole_mm = 4.0});
    std::size_t changed = 0;
    for (std::size_t v = 0; v < shell.size(); ++v) {
        if (protect[v] != 0) CHECK(result.solid[v] == states[v]);
        if (result.solid[v] != states[v]) ++changed;
    }
    CHECK(changed > 0);
}

TEST_CASE("enlarge: the same for any number of threads", "[enlarge]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(10.0, 4), {.resolution = 40});
    const SolidStates states = paint(shell, random_blobs(5, 5.0));
    const EnlargeSettings settings{.min_feature_mm = 1.5, .min_hole_mm = 1.5};
    SolidStates first;
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        const EnlargeResult result = enlarge(shell, states, {}, settings);
        if (first.empty()) first = result.solid;
        CHECK(result.solid == first);
    }
}

TEST_CASE("enlarge: says what cannot be met", "[enlarge]") {
    const SurfaceVoxels shell = voxelize(make_square(20.0), {.resolution = 20});
    const SolidStates all(shell.size(), SolidState::kSolid);
    const auto run = [&](double feature, double hole) {
        return enlarge(shell, all, {}, {.min_feature_mm = feature, .min_hole_mm = hole});
    };
    CHECK_THROWS_AS(run(0.0, 3.0), InvalidSetting);
    CHECK_THROWS_AS(run(3.0, -1.0), InvalidSetting);
    CHECK_THROWS_AS(run(std::numeric_limits<double>::quiet_NaN(), 3.0), InvalidSetting);
    CHECK_THROWS_AS(run(1.9, 3.0), ConstraintsNotMet);
    CHECK_THROWS_AS(run(3.0, 0.8), ConstraintsNotMet);
    CHECK_THROWS_AS(run(11.0, 3.0), ConstraintsNotMet);
    CHECK_THROWS_AS(enlarge(shell, SolidStates(3), {}, {}), InvalidInput);
    CHECK_THROWS_AS(enlarge({}, {}, {}, {}), InvalidInput);
    // The resolution it names is enough.
    try {
        run(1.0, 3.0);
        FAIL("expected an error");
    } catch (const ConstraintsNotMet& error) {
        const std::string text = error.what();
        const int resolution = std::stoi(text.substr(text.find("resolution to ") + 14));
        const SurfaceVoxels finer = voxelize(make_square(20.0), {.resolution = resolution});
        CHECK_NOTHROW(enlarge(finer, SolidStates(finer.size(), SolidState::kSolid), {},
                              {.min_feature_mm = 1.0, .min_hole_mm = 3.0}));
    }
}

TEST_CASE("enlarge: stops when asked and reports progress in order", "[enlarge]") {
    const SurfaceVoxels shell = voxelize(make_icosphere(10.0, 3), {.resolution = 24});
    const SolidStates states = paint(shell, random_blobs(2, 6.0));
    const EnlargeSettings settings{.min_feature_mm = 2.5, .min_hole_mm = 2.5};
    double last = 0.0;
    enlarge(shell, states, {}, settings, RunControl([&](std::string_view, double fraction) {
                CHECK(fraction >= last);
                last = fraction;
            }));
    CHECK(last == 1.0);
    std::stop_source source;
    source.request_stop();
    CHECK_THROWS_AS(enlarge(shell, states, {}, settings, RunControl(nullptr, source.get_token())), Cancelled);
}

}  // namespace
}  // namespace fretwork
