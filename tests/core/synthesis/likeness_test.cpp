#include "support/likeness.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/synthesis/start_labels.h"
#include "core/synthesis/synthesis_problem.h"
#include "core/synthesis/synthesizer.h"
#include "synthesis_fixtures.h"

namespace fretwork {
namespace {

using namespace testing;

Likened picture_of(const Exemplar& e) {
    return likened(e.width, e.height, e.color, e.solid);
}

/// What a pattern shows on the upright plate, seen from the front.
Likened picture_of(const PyramidCase& c, const std::vector<Rgb8>& color, const std::vector<std::uint8_t>& solid) {
    VoxelCoord low = c.shell.coords.front(), high = low;
    for (const VoxelCoord& v : c.shell.coords)
        for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], v[a]), high[a] = std::max(high[a], v[a]);
    Likened picture{high[0] - low[0] + 1, high[2] - low[2] + 1, {}};
    picture.pixels.resize(static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height));
    const bool mirrored = c.shell.normals[0].y() > 0;  // seen from the side the normals point to
    for (std::size_t v = 0; v < c.shell.size(); ++v) {
        const int x = mirrored ? high[0] - c.shell.coords[v][0] : c.shell.coords[v][0] - low[0];
        const int y = high[2] - c.shell.coords[v][2];
        picture.pixels[static_cast<std::size_t>(y * picture.width + x)] =
            likened(1, 1, {color[v]}, {solid[v]}).pixels[0];
    }
    return picture;
}

Likened synthesized_picture(const PyramidCase& c, const Exemplar& e, std::uint64_t seed) {
    SynthesisSettings settings;
    settings.seed = seed;
    Synthesizer synthesizer(c.pyramid, e, settings);
    synthesizer.synthesize();
    std::vector<std::uint8_t> solid;
    for (const SolidState s : read_solid(e, synthesizer.frames())) solid.push_back(s == SolidState::kSolid ? 1 : 0);
    return picture_of(c, read_color(e, synthesizer.frames()), solid);
}

Likened random_picture(const PyramidCase& c, const Exemplar& e) {
    SynthesisProblem problem(c.pyramid, e, {});
    problem.prepare({});
    std::vector<Rgb8> color;
    std::vector<std::uint8_t> solid;
    for (const Choice& choice : random_labels(problem, problem.levels[0])) {
        color.push_back(e.color[problem.map.pixel(choice.texel)]);
        solid.push_back(e.solid[problem.map.pixel(choice.texel)]);
    }
    return picture_of(c, color, solid);
}

TEST_CASE("likeness: the exemplar itself is verbatim and covered, random labels are neither", "[synthesis]") {
    const Exemplar e = discs(48, 5.0);
    const LikenessMeter meter(picture_of(e));
    const Likeness own = meter.measure(picture_of(e), 300);
    CHECK(own.worst_seam < 1e-6);
    CHECK(own.coverage < 0.1);  // 300 windows fall unevenly into 16 cells: about .05
    CHECK(meter.measure(random_picture(plate_case(64), e), 200).worst_seam > 0.4);
}

TEST_CASE("likeness: plates show few seams and all of the exemplar", "[synthesis][property]") {
    const std::uint64_t seed = GENERATE(1u, 2u);
    constexpr int kStripes = 64;
    const PyramidCase c = plate_case(96);
    for (const Exemplar& e : {discs(48, 5.0), discs(60, 6.5, false), stripes(kStripes)}) {
        CAPTURE(seed, e.width, e.tileable);
        const Likeness found = LikenessMeter(picture_of(e)).measure(synthesized_picture(c, e, seed), 250);
        // Measured .08 to .25: hard edges make every seam count. Random labels exceed .4.
        CHECK(found.worst_seam < 0.3);
        // All stripes are alike, so that the first window wins; else only the sampling and, without
        // tiling, the band along the borders count.
        if (e.width != kStripes) CHECK(found.coverage < 0.2);
    }
}

}  // namespace
}  // namespace fretwork
