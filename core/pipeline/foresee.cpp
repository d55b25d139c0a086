#include "core/pipeline/foresee.h"

#include <fmt/format.h>

#include <cmath>

namespace fretwork {
namespace {

constexpr double kLeastRepeats = 2.0;
constexpr double kMostLayerOfNozzle = 0.8;
constexpr double kSlack = 1.0 - 1e-9;

/// Two digits up, so that what is named is enough.
double enough(double value) {
    const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return std::ceil(value / digit * kSlack) * digit;
}

/// What is drawn narrower than what is kept of it.
struct Narrow {
    const char* what;
    const char* becomes;
    const char* key;
    double drawn_mm, least_mm;
    double least_voxels;
};

/// A finer grid helps where the grid sets the limit, a larger pattern as long as the model is large enough for it.
std::string remedy(const Narrow& narrow, const ResolvedSettings& r, const FabricationOptions& fabrication,
                   double scale) {
    const double factor = narrow.least_mm / narrow.drawn_mm;
    std::string text;
    if (factor * r.exemplar_width_mm <= r.longest_side_mm)
        text = fmt::format("synthesis.scale = {:.3g} draws them that wide", enough(scale * factor));
    const double grid_mm = narrow.least_voxels * r.voxel_mm;
    if (grid_mm >= narrow.least_mm * kSlack && grid_mm > 2.0 * fabrication.nozzle_mm) {
        const double wanted_mm = std::max(narrow.drawn_mm, 2.0 * fabrication.nozzle_mm);
        text += fmt::format("{}shell.resolution = {:.0f} allows {:.3g} mm", text.empty() ? "" : ", ",
                            std::ceil(narrow.least_voxels * r.longest_side_mm / wanted_mm), wanted_mm);
    }
    if (text.empty()) text = "a picture with fewer and wider strokes, or a larger model, helps";
    return text;
}

}  // namespace

std::vector<std::string> foreseen(const ResolvedSettings& r, const ExemplarFacts& exemplar,
                                  const FabricationOptions& fabrication, double synthesis_scale) {
    std::vector<std::string> all;
    const double mm_per_px = r.exemplar_width_mm / exemplar.width_px;
    const Narrow strokes{"strokes",
                         "grow to",
                         "fabrication.min_feature_mm",
                         2.0 * exemplar.half_stroke_px * mm_per_px,
                         r.enlarge.min_feature_mm,
                         kLeastFeatureVoxels};
    const Narrow openings{"openings",
                          "are widened or filled below",
                          "fabrication.min_hole_mm",
                          2.0 * exemplar.half_gap_px * mm_per_px,
                          r.enlarge.min_hole_mm,
                          kLeastHoleVoxels};
    for (const Narrow& narrow : {strokes, openings})
        if (narrow.drawn_mm < narrow.least_mm * kSlack)
            all.push_back(fmt::format("{} of the pattern are about {:.2g} mm wide and {} {} = {:.3g}; {}", narrow.what,
                                      narrow.drawn_mm, narrow.becomes, narrow.key, narrow.least_mm,
                                      remedy(narrow, r, fabrication, synthesis_scale)));
    const double wall = r.solidify.thickness_mm, two_lines = 2.0 * fabrication.nozzle_mm;
    if (wall < two_lines * kSlack)
        all.push_back(
            fmt::format("the wall of {:.3g} mm is under two printed lines of {:g} mm and may come out as one; "
                        "use shell.thickness_mm = {:.3g} or a finer fabrication.nozzle_mm",
                        wall, fabrication.nozzle_mm, two_lines));
    const double most_layer = kMostLayerOfNozzle * fabrication.nozzle_mm;
    if (fabrication.layer_height_mm > most_layer / kSlack)
        all.push_back(
            fmt::format("layers of {:g} mm hold badly to each other with a nozzle of {:g} mm; use "
                        "fabrication.layer_height_mm = {:.3g} or less",
                        fabrication.layer_height_mm, fabrication.nozzle_mm, most_layer));
    const double repeats = r.longest_side_mm / r.exemplar_width_mm;
    if (repeats < kLeastRepeats * kSlack)
        all.push_back(
            fmt::format("the pattern is {:.3g} mm wide on a model of {:.3g} mm and hardly repeats; "
                        "synthesis.scale = {:.3g} shows it twice",
                        r.exemplar_width_mm, r.longest_side_mm, synthesis_scale * repeats / kLeastRepeats));
    return all;
}

}  // namespace fretwork
