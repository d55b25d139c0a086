#include "core/exemplar/exemplar.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/base/error.h"
#include "core/exemplar/otsu.h"
#include "core/exemplar/resample_image.h"
#include "core/exemplar/tileability.h"
#include "support/make_pictures.h"

namespace fretwork {
namespace {

using testing::crop;
using testing::grey;
using testing::make_picture;

/// Left half dark, right half light.
Image two_halves(int dark, int light) {
    return make_picture(16, 8, [&](int x, int) { return grey(x < 8 ? dark : light); });
}

bool left_is_solid(const Exemplar& e) {
    for (int y = 0; y < e.height; ++y)
        for (int x = 0; x < e.width; ++x)
            if ((e.solid[static_cast<std::size_t>(y * e.width + x)] == 1) != (2 * x < e.width)) return false;
    return true;
}

TEST_CASE("otsu: cuts in the middle between two values", "[exemplar]") {
    Histogram h{};
    h[40] = 10;
    h[200] = 30;
    CHECK(otsu_threshold(h) == 120.0);  // every cut from 40.5 to 199.5 parts them alike
}

TEST_CASE("otsu: maximises the variance between the classes", "[exemplar]") {
    // 0 x 4, 1 x 2, 3 x 2, 4 x 4 of total 12: cut after 1 gives means 1/3 and 11/3, 36 (10/3)^2 = 400; cut after 0
    // gives 4 * 8 * (22/8)^2 = 242; cut after 3 the same by symmetry. Cuts after 1 and after 2 are equal.
    Histogram h{};
    h[0] = 4;
    h[1] = 2;
    h[3] = 2;
    h[4] = 4;
    CHECK(otsu_threshold(h) == 2.0);
}

TEST_CASE("otsu: has no answer for a single value", "[exemplar]") {
    Histogram h{};
    CHECK_FALSE(otsu_threshold(h).has_value());
    h[77] = 5;
    CHECK_FALSE(otsu_threshold(h).has_value());
}

TEST_CASE("exemplar: by default dark is solid, unless the alpha channel varies", "[exemplar]") {
    CHECK(left_is_solid(make_exemplar(two_halves(30, 220))));
    CHECK(left_is_solid(make_exemplar(two_halves(100, 120))));

    const Image see_through = make_picture(
        16, 8, [](int x, int) { return grey(x < 8 ? 250 : 10, x < 8 ? 255 : 0); }, true);
    const Exemplar e = make_exemplar(see_through);
    CHECK(left_is_solid(e));
    CHECK(e.color.back() == Rgb8{255, 255, 255});  // what is transparent shows white, whatever colour lies there
    CHECK(e.color.front() == Rgb8{250, 250, 250});

    const Image all_opaque = make_picture(
        16, 8, [](int x, int) { return grey(x < 8 ? 30 : 220, 255); }, true);
    CHECK(left_is_solid(make_exemplar(all_opaque)));
}

TEST_CASE("exemplar: the threshold is where the user puts it", "[exemplar]") {
    const Image ramp = make_picture(256, 4, [](int x, int) { return grey(x); });
    const Exemplar e = make_exemplar(ramp, nullptr, {.mask = MaskSource::kThreshold, .threshold = 0.25});
    for (int x = 0; x < 256; ++x) {
        CAPTURE(x);
        CHECK(e.solid[static_cast<std::size_t>(x)] == (x / 255.0 < 0.25 ? 1 : 0));
    }
}

TEST_CASE("exemplar: invert exchanges the phases and the sign of the distance", "[exemplar]") {
    const Image picture = make_picture(20, 20, [](int x, int y) { return grey((x * 37 + y * y * 11) % 256); });
    const Exemplar plain = make_exemplar(picture, nullptr, {.mask = MaskSource::kThreshold, .threshold = 0.45});
    const Exemplar inverted =
        make_exemplar(picture, nullptr, {.mask = MaskSource::kThreshold, .threshold = 0.45, .invert = true});
    CHECK(plain.solid_fraction() + inverted.solid_fraction() == Approx(1.0));
    for (std::size_t i = 0; i < plain.solid.size(); ++i) {
        REQUIRE(plain.solid[i] != inverted.solid[i]);
        REQUIRE(plain.feature_distance_px[i] == Approx(-inverted.feature_distance_px[i]).margin(0.02));
        REQUIRE((plain.feature_distance_px[i] < 0) == (plain.solid[i] == 1));
    }
}

TEST_CASE("exemplar: a mask of another size is scaled to the picture", "[exemplar]") {
    const Image picture = make_picture(16, 8, [](int x, int y) { return grey(16 * x + y); });
    const auto left_light = [](int width, int height) {
        return make_picture(width, height, [&](int x, int) { return grey(2 * x < width ? 255 : 0); });
    };
    for (const auto& [w, h] : {std::pair{16, 8}, std::pair{64, 48}, std::pair{4, 4}, std::pair{160, 5}}) {
        CAPTURE(w, h);
        const Image mask = left_light(w, h);
        const Exemplar e = make_exemplar(picture, &mask, {.mask = MaskSource::kImage});
        CHECK(e.width == 16);
        CHECK(left_is_solid(e));
    }
}

TEST_CASE("exemplar: huge pictures are reduced, keeping their shape", "[exemplar]") {
    const Image huge = make_picture(600, 300, [](int x, int) { return grey(x < 300 ? 0 : 255); });
    const Exemplar e = make_exemplar(huge, nullptr, {.max_side_px = 100});
    CHECK(e.width == 100);
    CHECK(e.height == 50);
    CHECK(left_is_solid(e));
}

TEST_CASE("resample: shrinking averages light, growing keeps constants", "[exemplar]") {
    const Image checks = make_picture(8, 8, [](int x, int y) { return grey((x + y) % 2 == 0 ? 255 : 0); });
    const Image small = resample_image(checks, 4, 4);
    // Half the light of white is sRGB 188.
    for (const Rgba8& p : small.pixels) CHECK(p == grey(188));

    const Image flat = make_picture(5, 3, [](int, int) { return Rgba8{10, 200, 90, 255}; });
    for (const Rgba8& p : resample_image(flat, 17, 11).pixels) CHECK(p == Rgba8{10, 200, 90, 255});
    for (const Rgba8& p : resample_image(flat, 2, 2).pixels) CHECK(p == Rgba8{10, 200, 90, 255});

    const Image half_clear = make_picture(
        2, 1,
        [](int x, int) {
            return x == 0 ? Rgba8{255, 0, 0, 255} : Rgba8{0, 0, 255, 0};
        },
        true);
    CHECK(resample_image(half_clear, 1, 1).pixels[0] == Rgba8{255, 0, 0, 128});
    CHECK_THROWS_AS(resample_image(flat, 0, 3), InvalidInput);
}

TEST_CASE("tileability: a periodic picture tiles and a ramp does not", "[exemplar]") {
    const auto measure = [](const Image& image) {
        const Exemplar e = make_exemplar(image);
        CHECK(e.tileable == is_tileable(measure_wrap_step(e.color, e.solid, e.width, e.height)));
        return e.tileable;
    };
    const double turn = 2 * 3.141592653589793 / 32;
    const auto wave = [&](int x, int y) {
        return grey(static_cast<int>(127 + 60 * std::sin(turn * 2 * x) + 60 * std::sin(turn * (3 * y + x))));
    };
    CHECK(measure(make_picture(32, 32, wave)));
    CHECK(measure(make_picture(64, 32, wave)));
    CHECK_FALSE(measure(make_picture(23, 32, wave)));
    CHECK_FALSE(measure(make_picture(32, 27, wave)));
    CHECK_FALSE(measure(make_picture(64, 64, [](int x, int) { return grey(4 * x); })));

    const Image ramp = make_picture(32, 32, [](int x, int) { return grey(8 * x); });
    CHECK(make_exemplar(ramp, nullptr, {.tileable = true}).tileable);  // the user knows better
}

TEST_CASE("exemplar: rejects what holds no pattern", "[exemplar]") {
    const Image fine = two_halves(0, 255);
    const auto flat = [](int width, int height, int value) {
        return make_picture(width, height, [&](int, int) { return grey(value); });
    };
    CHECK_THROWS_AS(make_exemplar({}), InvalidInput);
    CHECK_THROWS_AS(make_exemplar(flat(1, 1, 0)), InvalidInput);
    CHECK_THROWS_AS(make_exemplar(flat(3, 40, 0)), InvalidInput);
    CHECK_THROWS_AS(make_exemplar(flat(40, 40, 128)), InvalidInput);  // no contrast for an automatic cut
    CHECK_THROWS_AS(make_exemplar(flat(40, 40, 0), nullptr, {.mask = MaskSource::kThreshold}), InvalidInput);
    CHECK_THROWS_AS(make_exemplar(flat(40, 40, 255), nullptr, {.mask = MaskSource::kThreshold}), InvalidInput);
    CHECK_THROWS_AS(make_exemplar(fine, nullptr, {.mask = MaskSource::kAlpha}), InvalidInput);
    CHECK_THROWS_AS(make_exemplar(fine, nullptr, {.mask = MaskSource::kImage}), InvalidInput);
    const Image black_mask = flat(16, 8, 0), tiny_mask = flat(1, 1, 255);
    CHECK_THROWS_AS(make_exemplar(fine, &black_mask, {.mask = MaskSource::kImage}), InvalidInput);
    CHECK_THROWS_AS(make_exemplar(fine, &tiny_mask, {.mask = MaskSource::kImage}), InvalidInput);
    Image lying = fine;
    lying.pixels.pop_back();
    CHECK_THROWS_AS(make_exemplar(lying), InvalidInput);

    CHECK_THROWS_AS(make_exemplar(fine, nullptr, {.threshold = 1.5}), InvalidSetting);
    CHECK_THROWS_AS(make_exemplar(fine, nullptr, {.threshold = std::nan("")}), InvalidSetting);
    CHECK_THROWS_AS(make_exemplar(fine, nullptr, {.max_side_px = 2}), InvalidSetting);
}

}  // namespace
}  // namespace fretwork
