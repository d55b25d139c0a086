#include "likeness/shape_statistics.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/error.h"
#include "test_pictures.h"

namespace fretwork::likeness {
namespace {

TEST_CASE("wasserstein: is the area between two quantile functions", "[likeness]") {
    CHECK(wasserstein({1, 2, 3}, {4, 2, 3}) == Approx(1.0));
    CHECK(wasserstein({0}, {0, 1}) == Approx(0.5));
    CHECK(wasserstein({0, 0, 3}, {1, 1}) == Approx((1 + 1 + 2) / 3.0));
    CHECK(wasserstein({5, 1}, {1, 5}) == 0.0);
    CHECK_THROWS_AS(wasserstein({}, {1}), InvalidInput);
}

TEST_CASE("wasserstein: relative to the reference's mean, with an answer for missing phases", "[likeness]") {
    CHECK(relative_wasserstein({3}, {2}) == Approx(0.5));
    CHECK(relative_wasserstein({}, {2}) == 1.0);
    CHECK(relative_wasserstein({}, {}) == 0.0);
}

TEST_CASE("chords: stripes have the runs they were drawn with", "[likeness]") {
    const bool wraps = GENERATE(false, true);
    const PatternPicture picture = stripes_picture(40, 20, 3, 5, wraps);
    CAPTURE(wraps);
    const std::vector<double> solid = chord_lengths(picture, true, 0), empty = chord_lengths(picture, false, 0);
    // Five periods; without wrapping the first run of solid and the last of empty touch the border.
    CHECK(solid.size() == (wraps ? 100u : 80u));
    CHECK(empty.size() == (wraps ? 100u : 80u));
    CHECK(std::ranges::all_of(solid, [](double l) { return l == 3.0; }));
    CHECK(std::ranges::all_of(empty, [](double l) { return l == 5.0; }));
    CHECK(chord_lengths(picture, true, 1).empty());  // never ends
    for (const int diagonal : {2, 3}) {
        const std::vector<double> slanted = chord_lengths(picture, true, diagonal);
        REQUIRE_FALSE(slanted.empty());
        CHECK(std::ranges::max(slanted) == Approx(3.0 * std::sqrt(2.0)));
        CHECK(std::ranges::min(slanted) == Approx(3.0 * std::sqrt(2.0)));
    }
}

TEST_CASE("chords: diagonals of a picture that does not wrap are all seen", "[likeness]") {
    PatternPicture picture = stripes_picture(9, 9, 9, 1, false);
    const auto clear = [&](int x, int y) { picture.pixels[static_cast<std::size_t>(9 * y + x)] = {}; };
    clear(7, 1), clear(4, 4);  // on one diagonal of direction 3, with two solid pixels between them
    CHECK(chord_lengths(picture, true, 3) == std::vector<double>{2 * std::sqrt(2.0)});
    CHECK(chord_lengths(picture, false, 2) == std::vector<double>(2, std::sqrt(2.0)));
}

TEST_CASE("thickness: distances within stripes count from both sides", "[likeness]") {
    const std::vector<double> solid = thicknesses(stripes_picture(32, 8, 4, 4, true), true);
    CHECK(solid.size() == 16u * 8u);
    for (const double d : {0.5, 1.5})
        CHECK(std::ranges::count_if(solid, [d](double x) { return std::abs(x - d) < 1e-6; }) == 64);
}

}  // namespace
}  // namespace fretwork::likeness
