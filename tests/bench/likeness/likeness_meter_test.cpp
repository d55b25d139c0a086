#include "likeness/likeness_meter.h"

#include <catch2/catch.hpp>
#include <string>

#include "core/base/parallel.h"
#include "likeness/baselines.h"
#include "test_pictures.h"

namespace fretwork::likeness {
namespace {

constexpr MeterSettings kSmall{.samples = 200, .levels = 2};

TEST_CASE("likeness meter: an exemplar is like itself", "[likeness]") {
    const PatternPicture exemplar = cells_picture(64);
    const LikenessMeter meter(exemplar, kSmall);
    PatternPicture own = exemplar;
    own.wraps = false;
    const Likeness found = meter.measure(own);
    CHECK(found.coherence < 1e-6);
    CHECK(found.worst_seam < 1e-6);
    CHECK(found.completeness < 0.1);  // half-pixel phases and windows across the border are not in it
    CHECK(found.solid_difference < 1e-6);
    CHECK(found.thickness < 0.05);
    CHECK(found.chords < 0.15);   // runs that touch the border are dropped from the output only
    CHECK(found.coverage < 0.1);  // 200 windows fall unevenly into 16 cells
}

TEST_CASE("likeness meter: crop < good synthesis < patch tiling < noise", "[likeness][property]") {
    const std::string name = GENERATE("cells", "hooks", "zebra");
    CAPTURE(name);
    const PatternPicture exemplar = builtin_picture(name, 80);
    const LikenessMeter meter(exemplar, kSmall);
    std::vector<Likeness> crop, synthesis, tiling, noise;
    for (const std::uint64_t seed : {1u, 2u}) {
        const auto measured = [&](const SourceMap& map) { return meter.measure(picture_of(map, exemplar, seed)); };
        crop.push_back(measured(crop_map(exemplar, 80, seed)));
        synthesis.push_back(measured(synthesized_map(exemplar, 80, seed)));
        tiling.push_back(measured(tiled_map(exemplar, 80, seed)));
        noise.push_back(measured(noise_map(exemplar, 80, seed)));
    }
    const Likeness a = mean_of(crop), b = mean_of(synthesis), c = mean_of(tiling), d = mean_of(noise);
    CHECK(a.worst_seam < b.worst_seam);
    CHECK(b.worst_seam < c.worst_seam);
    CHECK(c.worst_seam < d.worst_seam);
    CHECK(a.patches() < b.patches());
    CHECK(b.patches() < c.patches());
    CHECK(c.patches() < d.patches());
}

TEST_CASE("likeness meter: worst seams are those few windows that match worst", "[likeness]") {
    const PatternPicture exemplar = cells_picture(64);
    PatternPicture flawed = exemplar;
    flawed.wraps = false;
    for (int y = 30; y < 36; ++y)
        for (int x = 30; x < 36; ++x) flawed.pixels[static_cast<std::size_t>(64 * y + x)] = {0.0F, 1.0F, 0.0F, 0.5F};
    const Likeness found = LikenessMeter(exemplar, {.samples = 3000, .levels = 1}).measure(flawed);
    // 12 x 12 of 58 x 58 windows see the flaw, 4.3 %: all of them are among the worst 5 %, which hold all of the mean.
    CHECK(found.coherence > 0.01);
    CHECK(found.worst_seam == Approx(found.coherence / 0.05).epsilon(0.01));
}

TEST_CASE("likeness meter: collapse to one place is seen by coverage and completeness", "[likeness]") {
    PatternPicture exemplar = builtin_picture("animalskin", 64);
    exemplar.wraps = false;
    const LikenessMeter meter(exemplar, kSmall);
    // A verbatim piece, mirrored back and forth: no seam to speak of.
    const PatternPicture collapsed = read_picture(exemplar, 64, 64, [](int x, int y) {
        const auto folded = [](int i) { return i % 24 < 12 ? i % 12 : 11 - i % 12; };
        return Vec2(folded(x) + 0.5, folded(y) + 0.5);
    });
    const Likeness found = meter.measure(collapsed), own = meter.measure(exemplar);
    CHECK(found.coverage > own.coverage + 0.1);  // of 16 cells, little more than one is used
    CHECK(found.completeness > own.completeness + 0.05);
}

TEST_CASE("likeness meter: measures solid fraction and shapes", "[likeness]") {
    const LikenessMeter meter(stripes_picture(64, 64, 4, 4, true), kSmall);
    const Likeness wider = meter.measure(stripes_picture(64, 64, 6, 2, true));
    CHECK(wider.solid_difference == Approx(0.25));
    // Rows: |6-4|/4 and |2-4|/4, and so on diagonals; columns never end in both: 0. Mean over four directions.
    CHECK(wider.chords == Approx(0.75 * 0.5));
    // Distances {.5, 1.5} become {.5, 1.5, 2.5} and {.5}: both half a pixel off a mean of one.
    CHECK(wider.thickness == Approx(0.5));
}

TEST_CASE("likeness meter: says the same on any number of threads", "[likeness]") {
    const PatternPicture exemplar = cells_picture(64);
    const PatternPicture output = picture_of(tiled_map(exemplar, 64, 1), exemplar, 1);
    const auto measured = [&](int threads) {
        const ThreadLimit limit(threads);
        return LikenessMeter(exemplar, kSmall).measure(output);
    };
    const Likeness one = measured(1), two = measured(2);
    CHECK(one.coherence == two.coherence);
    CHECK(one.completeness == two.completeness);
    CHECK(one.worst_seam == two.worst_seam);
}

}  // namespace
}  // namespace fretwork::likeness
