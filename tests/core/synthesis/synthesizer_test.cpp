#include "core/synthesis/synthesizer.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <set>
#include <stop_token>
#include <tuple>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/exemplar/builtin/builtin_patterns.h"
#include "core/synthesis/optimize.h"
#include "core/synthesis/start_labels.h"
#include "core/synthesis/synthesis_presets.h"
#include "core/synthesis/synthesis_problem.h"
#include "synthesis_fixtures.h"

namespace fretwork {
namespace {

using namespace testing;

bool same_frames(const TexelFrames& a, const TexelFrames& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const TexelFrame& x, const TexelFrame& y) {
        return x.u == y.u && x.v == y.v && x.du == y.du && x.dv == y.dv;
    });
}

TexelFrames synthesize(const PyramidCase& c, const Exemplar& e, const SynthesisSettings& settings) {
    Synthesizer synthesizer(c.pyramid, e, settings);
    synthesizer.synthesize();
    return synthesizer.frames();
}

double solid_share(const Exemplar& e, const TexelFrames& frames) {
    const SolidStates solid = read_solid(e, frames);
    return static_cast<double>(std::count(solid.begin(), solid.end(), SolidState::kSolid)) /
           static_cast<double>(solid.size());
}

TEST_CASE("synthesizer: the same labels for any number of threads and either instruction set", "[synthesis]") {
    const auto preset = GENERATE(SynthesisPreset::kDefault, SynthesisPreset::kPaper);
    const PyramidCase c = sphere_case(40);
    const Exemplar e = discs(50, 4.5, false);
    SynthesisSettings settings = synthesis_settings(preset);
    const TexelFrames reference = synthesize(c, e, settings);
    for (const int threads : {1, 2, 4}) {
        CAPTURE(threads);
        const ThreadLimit limit(threads);
        CHECK(same_frames(reference, synthesize(c, e, settings)));
    }
    settings.portable_code = true;
    CHECK(same_frames(reference, synthesize(c, e, settings)));
    settings.seed = 2;
    CHECK_FALSE(same_frames(reference, synthesize(c, e, settings)));
}

TEST_CASE("synthesizer: frames lie in the exemplar, and equal labels are one continuous piece", "[synthesis]") {
    const PyramidCase c = sphere_case(48);
    const Exemplar e = hills(70, 45);
    const TexelFrames frames = synthesize(c, e, {});
    REQUIRE(frames.size() == c.shell.size());
    const PyramidLevel& level = c.pyramid.levels[0];
    std::size_t joined = 0, pairs = 0;
    for (VoxelIndex v = 0; v < level.size(); ++v) {
        REQUIRE((frames[v].u >= 0.0F && frames[v].u < 70.0F));
        REQUIRE((frames[v].v >= 0.0F && frames[v].v < 45.0F));
        for (const VoxelIndex w : level.adjacency.of(v)) {
            ++pairs;
            if (frames[v].du != frames[w].du || frames[v].dv != frames[w].dv) continue;
            const Vec3f d = level.positions[w] - level.positions[v];
            const Vec2 gap = modulo_period(texel_of(frames[v], d) - texel_of(frames[w], Vec3f::Zero()), e);
            if (gap.norm() < 2e-3) ++joined;  // the others are pieces with the same axes
        }
    }
    CHECK(joined > pairs / 3);
}

TEST_CASE("synthesizer: optimising beats random labels many times over", "[synthesis]") {
    const PyramidCase c = plate_case(64);
    const Exemplar e = stripes(48);
    SynthesisProblem problem(c.pyramid, e, {});
    problem.prepare({});
    const double random = total_energy(problem, problem.levels[0], random_labels(problem, problem.levels[0]));
    Synthesizer synthesizer(c.pyramid, e, {});
    synthesizer.synthesize();
    CHECK(synthesizer.energy() < 0.05 * random);
}

TEST_CASE("synthesizer: a picture that does not tile is rearranged, not repeated", "[synthesis]") {
    const PyramidCase c = plate_case(128);
    const Exemplar e = discs(48, 5.0, false);
    const TexelFrames frames = synthesize(c, e, {});
    // Positions of the pieces modulo the period: a plain tiling has one.
    std::set<std::tuple<long, long>> origins;
    const PyramidLevel& level = c.pyramid.levels[0];
    std::size_t near_border = 0;
    for (VoxelIndex v = 0; v < level.size(); ++v) {
        const Vec2 origin = texel_of(frames[v], -level.positions[v]);
        origins.insert({std::lround(origin.x() - 48 * std::floor(origin.x() / 48)),
                        std::lround(origin.y() - 48 * std::floor(origin.y() / 48))});
        const float u = frames[v].u, w = frames[v].v;
        if (std::min({u, w, 48 - u, 48 - w}) < 0.05F * 48) ++near_border;
    }
    CHECK(origins.size() > 5);
    // The band holds 19 % of the picture.
    CHECK(near_border < level.size() / 10);
}

TEST_CASE("synthesizer: keeps the solid fraction of the exemplar", "[synthesis][property]") {
    const std::uint64_t seed = GENERATE(1u, 2u);
    const PyramidCase c = sphere_case(80);
    for (const Exemplar& e : {discs(64, 5.0), discs(60, 6.5, false), stripes(48), make_builtin("cells")}) {
        SynthesisSettings settings;
        settings.seed = seed;
        CAPTURE(e.width, e.solid_fraction(), seed);
        CHECK(std::fabs(solid_share(e, synthesize(c, e, settings)) - e.solid_fraction()) < 0.05);
    }
}

TEST_CASE("synthesizer: the picture stands upright where the field is clear, any way up when free", "[synthesis]") {
    const PyramidCase c = sphere_case(40);
    const Exemplar e = stripes(32);
    const auto mean_agreement = [&](const SynthesisSettings& settings) {
        const TexelFrames frames = synthesize(c, e, settings);
        double sum = 0, count = 0;
        for (std::size_t v = 0; v < frames.size(); ++v) {
            const Vec3f& n = c.pyramid.levels[0].normals[v];
            const Vec3f along = settings.direction.cast<float>();
            const Vec3f up = along - along.dot(n) * n;
            if (up.norm() < 0.8F) continue;
            sum += static_cast<double>(-frames[v].dv.normalized().dot(up.normalized()));
            ++count;
        }
        return sum / count;
    };
    SynthesisSettings settings;
    CHECK(mean_agreement(settings) > 0.95);
    settings.direction = Vec3(2, 0, 0);
    CHECK(mean_agreement(settings) > 0.95);
    settings.orientation = Orientation::kFree;
    CHECK(mean_agreement(settings) < 0.8);
}

TEST_CASE("synthesizer: works on every odd input", "[synthesis]") {
    const PyramidCase tiny = pyramid_of(make_icosphere(1, 1), 4);
    const PyramidCase sphere = sphere_case(20);
    for (const Exemplar& e : {hills(5, 4), hills(7, 200, false), stripes(300)})
        for (const double scale : {0.1, 1.0, 30.0})
            for (const PyramidCase* c : {&tiny, &sphere}) {
                SynthesisSettings settings;
                settings.pixels_per_voxel = scale;
                const TexelFrames frames = synthesize(*c, e, settings);
                REQUIRE(frames.size() == c->shell.size());
                for (const TexelFrame& f : frames) {
                    REQUIRE((f.u >= 0 && f.u < static_cast<float>(e.width) && f.v >= 0 &&
                             f.v < static_cast<float>(e.height)));
                    REQUIRE(f.du.norm() == Approx(scale).epsilon(1e-2));
                }
            }
}

TEST_CASE("synthesizer: the mask of a frame is the mask of its pixel", "[synthesis]") {
    Exemplar e = discs(40, 4.0);
    TexelFrames frames(3);
    frames[0].u = 39.9999F, frames[0].v = 0.0F;
    frames[1].u = 12.5F, frames[1].v = 7.25F;
    frames[2].u = -0.5F, frames[2].v = 80.5F;  // (39, 0) after wrapping
    const SolidStates solid = read_solid(e, frames);
    const auto mask = [&](std::size_t x, std::size_t y) {
        return e.solid[y * 40 + x] != 0 ? SolidState::kSolid : SolidState::kEmpty;
    };
    CHECK(solid[0] == mask(39, 0));
    CHECK(solid[1] == mask(12, 7));
    CHECK(solid[2] == mask(39, 0));
    // Half way between the middles of two pixels the colour is their mean.
    e.color[0] = {10, 20, 30}, e.color[1] = {30, 60, 90};
    frames[0].u = 1.0F, frames[0].v = 0.5F;
    CHECK(read_color(e, frames)[0] == Rgb8{20, 40, 60});
}

TEST_CASE("synthesizer: refuses settings out of range", "[synthesis]") {
    const PyramidCase c = sphere_case(8);
    const Exemplar e = hills(16, 16);
    const std::vector<std::function<void(SynthesisSettings&)>> mistakes = {
        [](auto& s) { s.pixels_per_voxel = 0; },
        [](auto& s) { s.pixels_per_voxel = std::numeric_limits<double>::quiet_NaN(); },
        [](auto& s) { s.pixels_per_voxel = 65; },
        [](auto& s) { s.direction = Vec3::Zero(); },
        [](auto& s) { s.orientation_smoothing = 2; },
        [](auto& s) { s.directions = 5; },
        [](auto& s) { s.rotations = 0; },
        [](auto& s) { s.translations = -1; },
        [](auto& s) { s.cone_deg = 91; },
        [](auto& s) { s.candidates = 0; },
        [](auto& s) { s.candidates = 257; },
        [](auto& s) { s.fine_random_candidates = -1; },
        [](auto& s) { s.transported = 65; },
        [](auto& s) { s.distortion_weight = -1; },
        [](auto& s) { s.orientation_weight = 101; },
        [](auto& s) { s.border_weight = -0.1; },
        [](auto& s) { s.border_band = 0.5; },
        [](auto& s) { s.feature_weight = 2; },
        [](auto& s) { s.coarse_passes = 0; },
        [](auto& s) { s.jitter = 1.5; },
        [](auto& s) { s.jitter_from_level = -1; },
        [](auto& s) { s.start_level = -1; },
    };
    for (std::size_t i = 0; i < mistakes.size(); ++i) {
        CAPTURE(i);
        SynthesisSettings settings;
        mistakes[i](settings);
        CHECK_THROWS_AS(Synthesizer(c.pyramid, e, settings), InvalidSetting);
    }
    CHECK_THROWS_AS(Synthesizer(VoxelPyramid{}, e, {}), InvalidInput);
    CHECK_THROWS_AS(Synthesizer(c.pyramid, Exemplar{}, {}), InvalidInput);
}

TEST_CASE("synthesizer: stops when asked and reports progress in order", "[synthesis]") {
    const PyramidCase c = sphere_case(24);
    const Exemplar e = hills(32, 32);
    double last = -1;
    Synthesizer synthesizer(c.pyramid, e, {});
    synthesizer.synthesize(RunControl([&](std::string_view stage, double fraction) {
        CHECK(stage == "synthesis");
        CHECK(fraction >= last);
        last = fraction;
    }));
    CHECK(last == 1.0);

    std::stop_source source;
    int calls = 0;
    const RunControl run(
        [&](std::string_view, double) {
            if (++calls == 4) source.request_stop();
        },
        source.get_token());
    CHECK_THROWS_AS(Synthesizer(c.pyramid, e, {}).synthesize(run), Cancelled);
    CHECK(calls == 4);
}

}  // namespace
}  // namespace fretwork
