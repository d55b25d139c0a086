// Pictures of every kind in, PNG out.
#include "formats/image_file.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

#include "core/base/counter_random.h"
#include "core/base/error.h"
#include "formats/png_reader.h"
#include "formats/png_writer.h"
#include "support/coded_pictures.h"

namespace fretwork {
namespace {

using testing::JpegKind;
using testing::make_jpeg;
using testing::make_png;
using testing::PngKind;

std::uint64_t bits_of(std::size_t item) {
    return counter_random(7, RandomStream::kTest, 9, item, 0);
}

std::vector<std::uint16_t> random_samples(std::size_t count, int bits) {
    std::vector<std::uint16_t> samples(count);
    for (std::size_t i = 0; i < count; ++i) samples[i] = static_cast<std::uint16_t>(bits_of(i) & ((1u << bits) - 1));
    return samples;
}

TEST_CASE("png: what is written is read back, with and without alpha", "[formats][property]") {
    for (const bool alpha : {false, true})
        for (const int width : {1, 7, 64}) {
            Image image{width, 5, {}, alpha};
            for (std::size_t i = 0; i < static_cast<std::size_t>(5 * width); ++i) {
                const std::uint64_t bits = bits_of(i);
                image.pixels.push_back({static_cast<std::uint8_t>(bits & 255),
                                        static_cast<std::uint8_t>(bits >> 8 & 255),
                                        static_cast<std::uint8_t>(bits >> 16 & 255),
                                        alpha ? static_cast<std::uint8_t>(bits >> 24 & 255) : std::uint8_t{255}});
            }
            const Image back = read_image(write_png(image), "memory");
            CHECK(back.width == width);
            CHECK(back.height == 5);
            CHECK(back.has_alpha == alpha);
            CHECK(back.pixels == image.pixels);
            CHECK(write_png(image) == write_png(image));
        }
}

TEST_CASE("png: grey of every depth, interlaced or not, becomes 8 bits", "[formats]") {
    for (const int bits : {1, 2, 4, 8, 16})
        for (const bool interlaced : {false, true}) {
            CAPTURE(bits, interlaced);
            const auto samples = random_samples(9 * 6, bits);
            const Image image = read_image(make_png(9, 6, {bits, 0, interlaced}, samples), "memory");
            REQUIRE(image.pixels.size() == samples.size());
            CHECK(!image.has_alpha);
            const double full = (1u << bits) - 1;
            for (std::size_t i = 0; i < samples.size(); ++i) {
                const auto expected = static_cast<std::uint8_t>(std::lround(255.0 * samples[i] / full));
                CHECK(image.pixels[i] == Rgba8{expected, expected, expected, 255});
            }
        }
}

TEST_CASE("png: palettes with transparency", "[formats]") {
    for (const int bits : {1, 2, 4, 8}) {
        const auto samples = random_samples(5 * 5, std::min(bits, 4));
        const Image image = read_image(make_png(5, 5, {bits, 3, bits == 4}, samples), "memory");
        CHECK(image.has_alpha);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const unsigned s = samples[i];
            CHECK(image.pixels[i] == Rgba8{static_cast<std::uint8_t>(s), static_cast<std::uint8_t>(2 * s),
                                           static_cast<std::uint8_t>(3 * s), static_cast<std::uint8_t>(255 - s)});
        }
    }
}

TEST_CASE("png: 16-bit colour with alpha, grey with alpha and a transparent grey", "[formats]") {
    const auto rgba = random_samples(4 * 3 * 4, 16);
    const Image color = read_image(make_png(4, 3, {16, 6, true}, rgba), "memory");
    CHECK(color.has_alpha);
    for (std::size_t i = 0; i < rgba.size(); ++i)
        CHECK(color.pixels[i / 4][i % 4] == std::lround(rgba[i] * 255.0 / 65535.0));

    const Image grey = read_image(make_png(2, 1, {8, 4}, {10, 20, 30, 40}), "memory");
    CHECK(grey.pixels[1] == Rgba8{30, 30, 30, 40});

    PngKind keyed{8, 0};
    keyed.transparent_grey = 7;
    const Image holes = read_image(make_png(2, 1, keyed, {7, 8}), "memory");
    CHECK(holes.has_alpha);
    CHECK(holes.pixels[0][3] == 0);
    CHECK(holes.pixels[1] == Rgba8{8, 8, 8, 255});
}

TEST_CASE("png: a picture that says it is linear comes out as sRGB", "[formats]") {
    PngKind kind{8, 0};
    kind.gamma = 1.0;
    const Image image = read_image(make_png(2, 1, kind, {128, 255}), "memory");
    // libpng takes sRGB as a power of 2.2: 255 * (128 / 255)^(1 / 2.2) = 186.4.
    CHECK(std::abs(image.pixels[0][0] - 186) <= 1);
    CHECK(image.pixels[1][0] == 255);
}

TEST_CASE("png: raw samples keep all their bits", "[formats]") {
    const auto samples = random_samples(6 * 4 * 3, 16);
    for (const int channels : {1, 3, 4}) {
        const auto part = std::vector<std::uint16_t>(samples.begin(), samples.begin() + 6 * 2 * channels);
        const RawPng raw = read_raw_png(write_png16(part, 6, 2, channels), "memory");
        CHECK(raw.bits == 16);
        CHECK(raw.channels == channels);
        CHECK(raw.samples == part);
    }
    const std::vector<std::uint8_t> grey = {0, 1, 254, 255};
    const RawPng raw = read_raw_png(write_png_gray8(grey, 2, 2), "memory");
    CHECK(raw.bits == 8);
    CHECK(std::equal(grey.begin(), grey.end(), raw.samples.begin(), raw.samples.end()));
}

std::vector<std::uint8_t> flat(std::initializer_list<std::uint8_t> pixel, std::size_t count) {
    std::vector<std::uint8_t> samples;
    for (std::size_t i = 0; i < count; ++i) samples.insert(samples.end(), pixel);
    return samples;
}

TEST_CASE("jpeg: grey, colour, progressive, and inks as Adobe and others store them", "[formats]") {
    struct Row {
        JpegKind kind;
        std::vector<std::uint8_t> samples;
        Rgba8 expected;
    };
    // Inks: cyan 0.2, magenta 0, yellow 1, black 0.5 -> red 0.8 * 0.5, green 0.5, blue 0.
    const Rgba8 inked = {102, 127, 0, 255};
    const std::vector<Row> rows = {
        {JpegKind::kGrey, flat({77}, 64), {77, 77, 77, 255}},
        {JpegKind::kRgb, flat({200, 40, 90}, 64), {200, 40, 90, 255}},
        {JpegKind::kProgressive, flat({20, 240, 90}, 64), {20, 240, 90, 255}},
        {JpegKind::kCmykAdobe, flat({204, 255, 0, 127}, 64), inked},
        {JpegKind::kYcck, flat({204, 255, 0, 127}, 64), inked},
        {JpegKind::kCmykPlain, flat({51, 0, 255, 128}, 64), inked},
    };
    for (const Row& row : rows) {
        CAPTURE(static_cast<int>(row.kind));
        const Image image = read_image(make_jpeg(8, 8, row.kind, row.samples), "memory");
        REQUIRE(image.pixels.size() == 64);
        CHECK(!image.has_alpha);
        for (std::size_t k = 0; k < 4; ++k)  // A flat block loses at most rounding in YCbCr.
            CHECK(std::abs(image.pixels[27][k] - row.expected[k]) <= 2);
    }
}

TEST_CASE("jpeg: turned upright as EXIF asks", "[formats]") {
    // Left half black, right half white, and the lower right quarter grey.
    std::vector<std::uint8_t> samples(16 * 32);
    for (std::size_t y = 0; y < 16; ++y)
        for (std::size_t x = 0; x < 32; ++x) samples[32 * y + x] = x < 16 ? 0 : y < 8 ? 255 : 128;
    // Where the grey quarter ends up: x and y of its half, for orientations 1 to 8.
    const int right[] = {1, 0, 0, 1, 1, 0, 0, 1}, lower[] = {1, 1, 0, 0, 1, 1, 0, 0};
    for (int orientation = 1; orientation <= 8; ++orientation) {
        CAPTURE(orientation);
        const Image image = read_image(make_jpeg(32, 16, JpegKind::kGrey, samples, orientation), "memory");
        const bool swapped = orientation > 4;
        REQUIRE(image.width == (swapped ? 16 : 32));
        REQUIRE(image.height == (swapped ? 32 : 16));
        const int x = image.width * (1 + 2 * right[orientation - 1]) / 4;
        const int y = image.height * (1 + 2 * lower[orientation - 1]) / 4;
        CHECK(std::abs(image.at(x, y)[0] - 128) <= 2);
    }
}

TEST_CASE("pictures: what cannot be read is named", "[formats][errors]") {
    const std::string png = make_png(40, 30, {8, 2}, random_samples(40 * 30 * 3, 8));
    CHECK_THROWS_WITH(read_image("", "a.png"), Catch::StartsWith("a.png: byte 0") && Catch::Contains("empty"));
    CHECK_THROWS_WITH(read_image("GIF89a...", "a.gif"), Catch::Contains("a GIF") && Catch::Contains("PNG or JPEG"));
    CHECK_THROWS_WITH(read_image("<svg/>", "a.svg"), Catch::Contains("SVG"));
    CHECK_THROWS_AS(read_image(std::string("\0\1\2", 3), "a"), InvalidInput);
    CHECK_THROWS_AS(read_image("RIFF.", "a"), InvalidInput);
    CHECK_THROWS_WITH(read_image("RIFF....WEBP", "a"), Catch::Contains("WebP"));
    CHECK_THROWS_WITH(read_image(png, "a.png", {.max_side_px = 39}), Catch::Contains("40 x 30"));
    CHECK_THROWS_WITH(read_image(png, "a.png", {.max_pixels = 1199}), Catch::Contains("40 x 30"));
    const std::string jpeg = make_jpeg(8, 8, JpegKind::kGrey, flat({77}, 64));
    CHECK_THROWS_WITH(read_image(jpeg, "a.jpg", {.max_side_px = 7}), Catch::Contains("8 x 8"));
    CHECK_THROWS_AS(read_image(std::filesystem::path("/nonexistent/a.png")), FileError);
    CHECK_THROWS_AS(write_png(Image{}), InvalidInput);
    // A header of 100000 x 100000 pixels without any data must not be believed.
    std::string lie = png;
    lie.replace(16, 8, std::string("\0\1\x86\xA0\0\1\x86\xA0", 8));
    CHECK_THROWS_AS(read_image(lie, "a.png"), InvalidInput);
}

TEST_CASE("pictures: cut off anywhere, they are refused", "[formats][errors]") {
    const std::string png = make_png(6, 5, {8, 6, true}, random_samples(6 * 5 * 4, 8));
    const std::string jpeg = make_jpeg(16, 16, JpegKind::kProgressive, flat({20, 240, 90}, 256));
    for (const std::string& whole : {png, jpeg})
        for (std::size_t size = 0; size < whole.size(); ++size) {
            CAPTURE(size, whole.size());
            CHECK_THROWS_AS(read_image(whole.substr(0, size), "cut"), InvalidInput);
        }
}

}  // namespace
}  // namespace fretwork
