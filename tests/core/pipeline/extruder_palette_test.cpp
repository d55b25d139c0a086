#include "core/pipeline/extruder_palette.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <set>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/exemplar/lab.h"

namespace fretwork {
namespace {

std::uint8_t random_byte(std::uint64_t seed, std::size_t item, std::uint32_t draw) {
    return static_cast<std::uint8_t>(counter_random(seed, RandomStream::kTest, 9, item, draw) & 0xFF);
}

/// Weighted mean of the squared distance from each colour to the nearest of the palette.
double cost_of(const std::vector<Rgb8>& colors, const std::vector<double>& weights, const std::vector<Rgb8>& palette) {
    double sum = 0.0;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        double least = 1e300;
        for (const Rgb8& p : palette) least = std::min(least, (srgb_to_lab(p) - srgb_to_lab(colors[i])).squaredNorm());
        sum += weights[i] * least;
    }
    return sum;
}

TEST_CASE("lab: known colours, and back again", "[exemplar]") {
    const auto near = [](const Lab& lab, double l, double a, double b) {
        return (lab - Lab(l, a, b)).norm() < 0.02;  // The tables print two digits.
    };
    CHECK(near(srgb_to_lab({255, 255, 255}), 100.0, 0.0, 0.0));
    CHECK(near(srgb_to_lab({0, 0, 0}), 0.0, 0.0, 0.0));
    CHECK(near(srgb_to_lab({255, 0, 0}), 53.24, 80.09, 67.20));
    CHECK(near(srgb_to_lab({0, 0, 255}), 32.30, 79.19, -107.86));
    for (std::size_t i = 0; i < 500; ++i) {
        const Rgb8 color = {random_byte(1, i, 0), random_byte(1, i, 1), random_byte(1, i, 2)};
        CHECK(lab_to_srgb(srgb_to_lab(color)) == color);
    }
}

TEST_CASE("palette: few colours are taken as they are, the most used first", "[pipeline]") {
    const std::vector<Rgb8> colors = {{10, 20, 30}, {200, 0, 0}, {10, 20, 30}, {0, 0, 250}};
    const std::vector<double> weights = {1.0, 3.0, 1.5, 2.0};
    const std::vector<Rgb8> all = {{200, 0, 0}, {10, 20, 30}, {0, 0, 250}};
    CHECK(extruder_palette(colors, weights, 4) == all);
    CHECK(extruders_of(colors, all) == std::vector<std::uint8_t>{2, 1, 2, 3});
    CHECK(extruder_palette(colors, weights, 1).size() == 1);
    CHECK_THROWS_AS(extruder_palette({}, {}, 4), InvalidInput);
    CHECK_THROWS_AS(extruder_palette(colors, std::vector<double>{1.0}, 4), InvalidInput);
}

TEST_CASE("palette: clouds of colour are told apart", "[pipeline]") {
    // Five clouds of 12 levels across, far from each other.
    const std::vector<Rgb8> middles = {{40, 40, 40}, {220, 50, 40}, {50, 200, 60}, {60, 60, 210}, {230, 220, 60}};
    std::vector<Rgb8> colors;
    for (std::size_t i = 0; i < 5000; ++i) {
        Rgb8 color = middles[i % 5];
        for (std::size_t k = 0; k < 3; ++k)
            color[k] = static_cast<std::uint8_t>(color[k] + random_byte(2, i, static_cast<std::uint32_t>(k)) % 13 - 6);
        colors.push_back(color);
    }
    const std::vector<double> weights(colors.size(), 1.0);
    const std::vector<Rgb8> palette = extruder_palette(colors, weights, 5);
    REQUIRE(palette.size() == 5);
    const std::vector<std::uint8_t> of = extruders_of(colors, palette);
    std::set<std::uint8_t> used;
    for (std::size_t i = 0; i < colors.size(); ++i) {
        CHECK(of[i] == of[i % 5]);
        used.insert(of[i]);
    }
    CHECK(used.size() == 5);
}

TEST_CASE("palette: more extruders serve better, and each colour is the mean of what it stands for",
          "[pipeline][property]") {
    const auto seed = GENERATE(range<std::uint64_t>(1, 5));
    std::vector<Rgb8> colors;
    std::vector<double> weights;
    for (std::size_t i = 0; i < 600; ++i) {
        colors.push_back({random_byte(seed, i, 0), random_byte(seed, i, 1), random_byte(seed, i, 2)});
        weights.push_back(1.0 + random_byte(seed, i, 3));
    }
    double last = 1e300;
    for (const int extruders : {1, 2, 4, 8, 16}) {
        const std::vector<Rgb8> palette = extruder_palette(colors, weights, extruders);
        const double cost = cost_of(colors, weights, palette);
        CHECK(cost < last);
        last = cost;
        const std::vector<std::uint8_t> of = extruders_of(colors, palette);
        for (std::size_t p = 0; p < palette.size(); ++p) {
            Lab sum = Lab::Zero();
            double weight = 0.0;
            for (std::size_t i = 0; i < colors.size(); ++i)
                if (of[i] == p + 1) {
                    sum += weights[i] * srgb_to_lab(colors[i]);
                    weight += weights[i];
                }
            REQUIRE(weight > 0.0);
            // Colours that count as one, and the rounding of the palette, may put a few on the other side of a border.
            CHECK((sum / weight - srgb_to_lab(palette[p])).norm() < 3.0);
        }
        for (const int threads : {1, 3}) {
            const ThreadLimit limit(threads);
            CHECK(extruder_palette(colors, weights, extruders) == palette);
        }
    }
}

}  // namespace
}  // namespace fretwork
