#include "core/exemplar/distance_transform.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

struct Grid {
    int width, height;
    bool wrap;
    std::vector<float> level;

    [[nodiscard]] float at(int x, int y) const {
        return level[static_cast<std::size_t>(((y % height + height) % height) * width + (x % width + width) % width)];
    }
    [[nodiscard]] bool exists(int x, int y) const { return wrap || (x >= 0 && x < width && y >= 0 && y < height); }
};

Grid random_grid(std::mt19937& rng, bool grey) {
    std::uniform_int_distribution<int> side(4, 15);
    std::uniform_real_distribution<float> value(-1.0f, 1.0f);
    Grid g{side(rng), side(rng), rng() % 2 == 0, {}};
    const float density = 0.9f * value(rng);
    for (int i = 0; i < g.width * g.height; ++i) {
        const float v = value(rng) - density;
        g.level.push_back(grey ? v : (v > 0 ? 0.5f : -0.5f));
    }
    return g;
}

/// Distance from (x, y) to the nearest place where the level changes sign between two neighbours, by trying all of
/// them (and all copies one period away).
double nearest_crossing(const Grid& g, int x, int y) {
    double best = std::numeric_limits<double>::infinity();
    const int reach_x = g.wrap ? g.width : 0, reach_y = g.wrap ? g.height : 0;
    for (int b = -reach_y; b < g.height + reach_y; ++b)
        for (int a = -reach_x; a < g.width + reach_x; ++a)
            for (const auto& [dx, dy] : {std::pair{1, 0}, std::pair{0, 1}}) {
                if (!g.exists(a, b) || !g.exists(a + dx, b + dy)) continue;
                const double here = g.at(a, b), there = g.at(a + dx, b + dy);
                if ((here > 0) == (there > 0)) continue;
                const double t = std::clamp(here / (here - there), 1.0 / 256, 255.0 / 256);
                best = std::min(best, std::hypot(a + t * dx - x, b + t * dy - y));
            }
    return best;
}

TEST_CASE("distance transform: agrees with trying every crossing", "[exemplar][property]") {
    const auto seed = GENERATE(range(0u, 60u));
    CAPTURE(seed);
    std::mt19937 rng{seed};
    const Grid g = random_grid(rng, seed % 3 != 0);
    CAPTURE(g.width, g.height, g.wrap);
    const std::vector<float> distance = signed_distance_px(g.level, g.width, g.height, g.wrap);
    for (int y = 0; y < g.height; ++y)
        for (int x = 0; x < g.width; ++x) {
            CAPTURE(x, y);
            const double got = distance[static_cast<std::size_t>(y * g.width + x)];
            const double crossing = nearest_crossing(g, x, y);
            REQUIRE((got < 0) == (g.at(x, y) > 0));
            if (std::isinf(crossing)) {
                REQUIRE(std::isinf(got));
                continue;
            }
            // Never farther than the nearest crossing. Segments between crossings are at most sqrt(2) long, so no
            // point of one is nearer than the root of crossing^2 - 1/2.
            REQUIRE(std::abs(got) <= crossing + 1e-5);
            REQUIRE(got * got >= crossing * crossing - 0.5 - 1e-4);
        }
}

TEST_CASE("distance transform: grey pixels place a slanted edge within a tenth of a pixel", "[exemplar]") {
    // Coverage of pixels by the half plane n . p < offset, by 16 x 16 samples.
    const double angle = GENERATE(0.0, 0.2, 0.5, std::numbers::pi / 4, 1.3);
    CAPTURE(angle);
    const double nx = std::cos(angle), ny = std::sin(angle), offset = 14.3;
    constexpr int kSide = 32;
    std::vector<float> level;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            int inside = 0;
            for (int s = 0; s < 256; ++s)
                inside += nx * (x + (s % 16 - 7.5) / 16) + ny * (y + (s / 16 - 7.5) / 16) < offset ? 1 : 0;
            level.push_back(static_cast<float>(inside) / 256.0f - 0.5f);
        }
    const std::vector<float> distance = signed_distance_px(level, kSide, kSide, false);
    for (int y = 8; y < 24; ++y)
        for (int x = 8; x < 24; ++x) {
            const double exact = nx * x + ny * y - offset;
            // Away from the picture's border, where the line ends and distances are measured to its end.
            if (std::abs(exact) > 7) continue;
            CAPTURE(x, y);
            CHECK(distance[static_cast<std::size_t>(y * kSide + x)] == Approx(exact).margin(0.1));
        }
}

TEST_CASE("distance transform: measures across the border only when told to wrap", "[exemplar]") {
    // One solid column at x = 1 of 12: pixel 11 is 2 - 1/2 away around the back, 10 - 1/2 otherwise.
    std::vector<float> level(12 * 5, -0.5f);
    for (int y = 0; y < 5; ++y) level[static_cast<std::size_t>(12 * y + 1)] = 0.5f;
    CHECK(signed_distance_px(level, 12, 5, true)[11] == Approx(1.5));
    CHECK(signed_distance_px(level, 12, 5, false)[11] == Approx(9.5));
    CHECK(signed_distance_px(level, 12, 5, true)[1] == Approx(-0.5));
}

TEST_CASE("distance transform: at a saddle the stronger phase is joined", "[exemplar]") {
    // Two solid pixels that touch at a corner. Where the empty ones beside the corner are weak, the border cuts each of
    // them off, between the crossings 1/6 px away on two links: at 1/6 / sqrt(2). Where they are strong, it cuts off
    // the solid ones.
    const auto distances = [](float empty) {
        std::vector<float> level(16, -1.0f);
        level[5] = level[10] = 1.0f;
        level[6] = level[9] = empty;
        return signed_distance_px(level, 4, 4, false);
    };
    CHECK(distances(-0.2f)[6] == Approx(std::sqrt(0.5) / 6));
    CHECK(distances(-5.0f)[10] == Approx(-std::sqrt(0.5) / 6));
}

TEST_CASE("distance transform: is infinite where there is no border", "[exemplar]") {
    const float infinity = std::numeric_limits<float>::infinity();
    CHECK(signed_distance_px(std::vector<float>(20, -1.0f), 5, 4, true) == std::vector<float>(20, infinity));
    CHECK(signed_distance_px(std::vector<float>(20, 1.0f), 5, 4, false) == std::vector<float>(20, -infinity));
}

TEST_CASE("distance transform: does not depend on the number of threads", "[exemplar][determinism]") {
    std::vector<float> level;
    for (int i = 0; i < 200 * 170; ++i)
        level.push_back(std::sin(0.11f * static_cast<float>(i % 200)) + std::cos(0.3f * static_cast<float>(i / 200)));
    const auto with = [&](int threads) {
        const ThreadLimit limit(threads);
        return signed_distance_px(level, 200, 170, true);
    };
    const std::vector<float> one = with(1);
    CHECK(with(2) == one);
    CHECK(with(5) == one);
}

}  // namespace
}  // namespace fretwork
