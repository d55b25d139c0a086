// Image stacks, held without their empty parts.
#include "formats/voxel_stack.h"

#include <catch2/catch.hpp>
#include <random>

#include "core/base/error.h"

namespace fretwork {
namespace {

/// Mostly one value, some pixels of others.
RawPng random_sheet(std::mt19937& random, int width, int height, int channels, int bits) {
    RawPng sheet{width, height, channels, bits, {}};
    const std::uint32_t most = bits == 16 ? 65536 : 256;
    for (int i = 0; i < width * height; ++i) {
        const bool empty = random() % 40 != 0;
        for (int c = 0; c < channels; ++c)
            sheet.samples.push_back(static_cast<std::uint16_t>(empty ? 7 : random() % most));
    }
    return sheet;
}

TEST_CASE("voxel stack: every sample is where it was", "[formats][property]") {
    const int channels = GENERATE(1, 2, 3, 4);
    const int bits = GENERATE(8, 16);
    const auto [width, height] = GENERATE(table<int, int>({{1, 1}, {7, 9}, {8, 16}, {33, 20}}));
    std::mt19937 random(static_cast<std::uint32_t>(channels * 100 + bits));
    std::vector<RawPng> sheets;
    VoxelStack stack;
    for (int k = 0; k < 3; ++k) {
        sheets.push_back(random_sheet(random, width, height, channels, bits));
        stack.add(tiled(sheets.back()));
    }
    const double full = bits == 16 ? 65535.0 : 255.0;
    bool same = true;
    for (int k = 0; k < 3; ++k)
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                for (int c = 0; c < 4; ++c) {
                    const auto sample = [&](int channel) {
                        return sheets[static_cast<std::size_t>(k)]
                                   .samples[static_cast<std::size_t>((y * width + x) * channels + channel)] /
                               full;
                    };
                    const bool alpha = channels == 2 || channels == 4;
                    const double expected = c == 3         ? (alpha ? sample(channels - 1) : 1.0)
                                            : channels < 3 ? sample(0)
                                                           : sample(c);
                    same = same && stack.at(x, y, k, static_cast<std::size_t>(c)) == expected;
                }
    CHECK(same);
}

TEST_CASE("voxel stack: tiles of one value take one pixel", "[formats]") {
    // 32 x 24 pixels of four channels: twelve tiles, of which one holds two values.
    RawPng sheet{32, 24, 4, 16, std::vector<std::uint16_t>(32 * 24 * 4, 5)};
    sheet.samples[(9 * 32 + 9) * 4] = 6;
    VoxelStack stack;
    stack.add(tiled(sheet));
    // The tiles before and after the uneven one share a pixel each.
    CHECK(stack.stored_samples() == (64 + 2) * 4);
    CHECK(stack.at(9, 9, 0, 0) == 6 / 65535.0);
    CHECK(stack.at(10, 9, 0, 0) == 5 / 65535.0);
    CHECK_THROWS_AS(stack.add(tiled(RawPng{32, 24, 4, 8, sheet.samples})), InvalidInput);
    CHECK_THROWS_AS(stack.add(tiled(RawPng{24, 32, 4, 16, sheet.samples})), InvalidInput);
}

}  // namespace
}  // namespace fretwork
