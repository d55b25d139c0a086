// What a run's numbers tell beforehand: each warning appears where it should, and following it makes it go away.
#include "core/pipeline/foresee.h"

#include <catch2/catch.hpp>
#include <cstdlib>

namespace fretwork {
namespace {

constexpr double kSideMm = 100.0;

std::vector<std::string> told(const Settings& settings, const ExemplarFacts& exemplar) {
    const ResolvedSettings resolved = resolve_settings(settings, {kSideMm, false, 2e4}, exemplar);
    return foreseen(resolved, exemplar, settings.fabrication, settings.synthesis.scale);
}

/// The number that a sentence names for a key of the spec.
double named(const std::string& sentence, const std::string& key) {
    const std::size_t at = sentence.rfind(key + " = ");
    CAPTURE(sentence, key);
    REQUIRE(at != sentence.npos);
    return std::atof(sentence.c_str() + at + key.size() + 3);
}

/// Strokes and openings of 2 x 4 pixels, 128 pixels wide.
ExemplarFacts picture(double width_mm) {
    return {128, 4.0, width_mm, 4.0};
}

TEST_CASE("foresee: nothing to say of a run that prints well", "[pipeline]") {
    CHECK(told({}, picture(40.0)).empty());
}

TEST_CASE("foresee: narrow strokes and openings are told, and the scale that is named mends them", "[pipeline]") {
    Settings settings;
    settings.fabrication.min_feature_mm = settings.fabrication.min_hole_mm = 3.0;
    ExemplarFacts exemplar = picture(40.0);  // 2.5 mm
    const auto both = told(settings, exemplar);
    REQUIRE(both.size() == 2);
    CHECK_THAT(both[0], Catch::Contains("strokes") && Catch::Contains("2.5 mm"));
    CHECK_THAT(both[1], Catch::Contains("openings") && Catch::Contains("fabrication.min_hole_mm = 3"));
    exemplar.half_gap_px = 5.0;
    CHECK(told(settings, exemplar).size() == 1);
    settings.synthesis.scale = named(both[0], "synthesis.scale");
    CHECK(settings.synthesis.scale == Approx(1.2).margin(0.01));
    CHECK(told(settings, exemplar).empty());
}

TEST_CASE("foresee: where the grid is what widens strokes, a finer one is named", "[pipeline]") {
    Settings settings;
    settings.shell.resolution = 64;  // two voxels are 3.1 mm
    const auto coarse = told(settings, picture(40.0));
    REQUIRE(coarse.size() == 1);
    settings.shell.resolution = static_cast<int>(named(coarse[0], "shell.resolution"));
    CHECK(*settings.shell.resolution == 80);
    CHECK(told(settings, picture(40.0)).empty());
}

TEST_CASE("foresee: walls, layers and patterns against nozzle and model", "[pipeline]") {
    Settings settings;
    settings.shell.thickness_mm = 1.1;
    settings.fabrication.nozzle_mm = 0.6;
    settings.fabrication.layer_height_mm = 0.55;
    const auto all = told(settings, picture(40.0));
    REQUIRE(all.size() == 2);
    settings.shell.thickness_mm = named(all[0], "shell.thickness_mm");
    settings.fabrication.layer_height_mm = named(all[1], "fabrication.layer_height_mm");
    CHECK(*settings.shell.thickness_mm == Approx(1.2));
    CHECK(settings.fabrication.layer_height_mm == Approx(0.48));
    CHECK(told(settings, picture(40.0)).empty());

    settings.exemplar.width_mm = 80.0;
    const auto wide = told(settings, picture(40.0));
    REQUIRE(wide.size() == 1);
    settings.synthesis.scale = named(wide[0], "synthesis.scale");
    CHECK(settings.synthesis.scale == Approx(0.625).margin(0.001));
    CHECK(told(settings, picture(40.0)).empty());
}

}  // namespace
}  // namespace fretwork
