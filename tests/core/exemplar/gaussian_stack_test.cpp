#include "core/exemplar/gaussian_stack.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <cstddef>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "support/make_pictures.h"

namespace fretwork {
namespace {

using namespace testing;

int channel(std::uint32_t texel, int c) {
    return static_cast<int>(texel >> (8 * c) & 0xFFu);
}

/// A picture of irregular blotches, `shift` pixels along.
Exemplar blotches(int width, int height, int shift, bool tileable) {
    const Image picture = make_picture(width, height, [&](int x, int y) {
        const int column = (x + shift) % width;
        return grey((column * 37 + y * 101 + column * y) % 256 < 128 ? 20 : 230);
    });
    ExemplarSettings settings;
    settings.tileable = tileable;
    return make_exemplar(picture, nullptr, settings);
}

double mean(const std::vector<std::uint32_t>& texels, int c) {
    double sum = 0;
    for (const std::uint32_t t : texels) sum += channel(t, c);
    return sum / static_cast<double>(texels.size());
}

TEST_CASE("gaussian stack: the finest level is the picture itself", "[exemplar]") {
    const Exemplar e = blotches(19, 12, 0, true);
    const GaussianStack stack = build_gaussian_stack(e, {});
    REQUIRE(stack.levels.size() == 1);
    for (std::size_t i = 0; i < e.color.size(); ++i) {
        for (int c = 0; c < 3; ++c) REQUIRE(channel(stack.levels[0][i], c) == e.color[i][static_cast<std::size_t>(c)]);
        // f: 128 on the border of the solid, less inside.
        REQUIRE((channel(stack.levels[0][i], 3) < 128) == (e.feature_distance_px[i] < 0.0F));
    }
}

TEST_CASE("gaussian stack: blur keeps the mean and takes contrast away", "[exemplar]") {
    const bool tileable = GENERATE(true, false);
    const GaussianStack stack = build_gaussian_stack(blotches(48, 32, 0, tileable), {.levels = 7});
    for (std::size_t l = 1; l < stack.levels.size(); ++l) {
        CAPTURE(l);
        CHECK(stack.contrast[l] < stack.contrast[l - 1]);
        // Wrapping and mirroring both count every pixel equally; 1/2 is the rounding to 8 bits.
        for (int c = 0; c < 4; ++c) CHECK(std::fabs(mean(stack.levels[l], c) - mean(stack.levels[0], c)) < 0.6);
    }
    CHECK(stack.contrast.back() < 0.02);
    // It ends with the first flat level, and is the same up to there.
    const GaussianStack part = build_gaussian_stack(blotches(48, 32, 0, tileable), {.levels = 7, .flat_contrast = 0.3});
    REQUIRE(part.levels.size() < stack.levels.size());
    REQUIRE(part.levels.size() > 1);
    CHECK(part.contrast.back() <= 0.3 * stack.contrast[0]);
    CHECK(part.contrast[part.contrast.size() - 2] > 0.3 * stack.contrast[0]);
    for (std::size_t l = 0; l < part.levels.size(); ++l) CHECK(part.levels[l] == stack.levels[l]);
}

TEST_CASE("gaussian stack: a spike spreads with the stated width", "[exemplar]") {
    // Columns of a picture that is white but for one black column: each row of the blurred picture is
    // the kernel, whose variance is sigma^2 = 0.1225 (16 - 1).
    const Exemplar e = make_exemplar(make_picture(64, 8, [](int x, int) { return grey(x == 32 ? 0 : 255); }));
    const GaussianStack stack = build_gaussian_stack(e, {.levels = 3});
    double sum = 0, moment = 0;
    for (int x = 0; x < 64; ++x) {
        const double weight = 255 - channel(stack.levels[2][static_cast<std::size_t>(x)], 0);
        sum += weight;
        moment += weight * (x - 32) * (x - 32);
    }
    CHECK(sum == Approx(255).epsilon(0.02));
    CHECK(moment / sum == Approx(0.1225 * 15).epsilon(0.05));
}

TEST_CASE("gaussian stack: wraps where the picture tiles", "[exemplar]") {
    const GaussianStack there = build_gaussian_stack(blotches(24, 20, 0, true), {.levels = 4});
    const GaussianStack shifted = build_gaussian_stack(blotches(24, 20, 7, true), {.levels = 4});
    for (std::size_t l = 0; l < 4; ++l)
        for (std::size_t y = 0; y < 20; ++y)
            for (std::size_t x = 0; x < 24; ++x)
                for (int c = 0; c < 3; ++c)
                    REQUIRE(std::abs(channel(there.levels[l][y * 24 + (x + 7) % 24], c) -
                                     channel(shifted.levels[l][y * 24 + x], c)) <= 1);
}

TEST_CASE("gaussian stack: the same for any number of threads", "[exemplar]") {
    const Exemplar e = blotches(40, 33, 0, false);
    const GaussianStack many = build_gaussian_stack(e, {.levels = 5});
    const ThreadLimit limit(1);
    CHECK(build_gaussian_stack(e, {.levels = 5}).levels == many.levels);
}

TEST_CASE("gaussian stack: rejects what makes no sense", "[exemplar]") {
    const Exemplar e = blotches(16, 16, 0, true);
    CHECK_THROWS_AS(build_gaussian_stack(e, {.levels = 0}), InvalidSetting);
    CHECK_THROWS_AS(build_gaussian_stack(e, {.pixels_per_voxel = 0.0}), InvalidSetting);
    CHECK_THROWS_AS(build_gaussian_stack(e, {.feature_weight = 1.5}), InvalidSetting);
}

}  // namespace
}  // namespace fretwork
