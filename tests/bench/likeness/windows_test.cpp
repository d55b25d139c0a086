#include "likeness/windows.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <limits>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "test_pictures.h"

namespace fretwork::likeness {
namespace {

TEST_CASE("windows: nearest is the one that a plain search finds", "[likeness][property]") {
    const PatternPicture picture = cells_picture(48);
    const PlacedWindows pool = all_windows(picture);
    const WindowBasis basis = principal_basis(pool.windows);
    const PatternPicture other = read_picture(
        picture, 20, 20, [](int x, int y) { return Vec2(x * 1.13 + y * 0.21 + 3.3, y * 0.94 - x * 0.17 + 7.1); });
    const Windows queries = all_windows(other).windows;
    const std::vector<Nearest> found = NearestWindows(pool.windows, basis).nearest(queries);
    for (Eigen::Index q = 0; q < queries.rows(); ++q) {
        CAPTURE(q);
        float least = std::numeric_limits<float>::max();
        for (Eigen::Index p = 0; p < pool.windows.rows(); ++p)
            least = std::min(least, (pool.windows.row(p) - queries.row(q)).squaredNorm());
        const Nearest& n = found[static_cast<std::size_t>(q)];
        CHECK(n.squared_distance == Approx(static_cast<double>(least)).margin(1e-6));
        CHECK((pool.windows.row(n.row) - queries.row(q)).squaredNorm() ==
              Approx(static_cast<float>(n.squared_distance)).margin(1e-6));
    }
}

TEST_CASE("windows: a picture that wraps has one per pixel, another one only those inside", "[likeness]") {
    PatternPicture picture = cells_picture(16);
    picture.wraps = true;
    CHECK(all_windows(picture).size() == 256);
    picture.wraps = false;
    CHECK(all_windows(picture).size() == 100);
    CHECK_THROWS_AS(all_windows(read_picture(picture, 6, 9, [](int x, int y) { return Vec2(x, y); })), InvalidInput);
}

TEST_CASE("windows: a sample holds distinct rows, the same ones for the same seed", "[likeness]") {
    const PlacedWindows all = all_windows(cells_picture(24));
    const PlacedWindows some = some_windows(all, 100, 7), again = some_windows(all, 100, 7);
    CHECK(some.windows == again.windows);
    CHECK(some_windows(all, 100, 8).corner != some.corner);
    for (std::size_t i = 0; i < some.size(); ++i) CHECK(std::ranges::count(some.corner, some.corner[i]) == 1);
    CHECK(some_windows(all, 100000, 7).size() == all.size());
}

TEST_CASE("windows: halving means over four pixels, from any start", "[likeness]") {
    PatternPicture picture{4, 4, true, {}};
    for (int i = 0; i < 16; ++i) picture.pixels.push_back({static_cast<float>(i), 0, 0, 0});
    CHECK(halved(picture).at(0, 0)[0] == Approx(2.5));
    CHECK(halved(picture, 1, 1).at(1, 1)[0] == Approx((15 + 12 + 3 + 0) / 4.0));  // around the corner
    picture.wraps = false;
    CHECK(halved(picture, 1, 0).width == 1);
}

}  // namespace
}  // namespace fretwork::likeness
