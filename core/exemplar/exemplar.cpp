#include "core/exemplar/exemplar.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>

#include "core/base/error.h"
#include "core/exemplar/color_space.h"
#include "core/exemplar/distance_transform.h"
#include "core/exemplar/otsu.h"
#include "core/exemplar/resample_image.h"
#include "core/exemplar/tileability.h"

namespace fretwork {
namespace {

constexpr int kMinSidePx = 4;

std::string size_text(const Image& image) {
    return std::to_string(image.width) + " x " + std::to_string(image.height) + " px";
}

void check_settings(const ExemplarSettings& s) {
    if (!(s.threshold >= 0.0 && s.threshold <= 1.0))
        throw InvalidSetting("exemplar.threshold is " + std::to_string(s.threshold) + "; expected a luma in [0, 1]");
    if (s.max_side_px < 16 || s.max_side_px > 8192)
        throw InvalidSetting("exemplar.max_side_px is " + std::to_string(s.max_side_px) + "; expected 16 to 8192");
}

void check_picture(const Image& image, const std::string& name) {
    if (image.width < kMinSidePx || image.height < kMinSidePx)
        throw InvalidInput(name + " is " + size_text(image) + "; expected at least " + std::to_string(kMinSidePx) +
                           " px on each side");
    if (image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
        throw InvalidInput(name + " claims " + size_text(image) + " but holds " + std::to_string(image.pixels.size()) +
                           " pixels");
}

Image reduce(const Image& picture, int max_side_px) {
    const int longest = std::max(picture.width, picture.height);
    if (longest <= max_side_px) return picture;
    const double scale = static_cast<double>(max_side_px) / longest;
    const auto side = [&](int px) { return std::max(kMinSidePx, static_cast<int>(std::lround(px * scale))); };
    return resample_image(picture, side(picture.width), side(picture.height));
}

/// What is transparent shows white paper: editors leave arbitrary colours there.
Rgb8 over_white(const Rgba8& c) {
    Rgb8 out{};
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = static_cast<std::uint8_t>((c[k] * c[3] + 255 * (255 - c[3]) + 127) / 255);
    return out;
}

bool alpha_varies(const Image& picture) {
    if (!picture.has_alpha) return false;
    const auto opaque = [](const Rgba8& c) { return c[3] >= 128; };
    return std::ranges::any_of(picture.pixels, opaque) && !std::ranges::all_of(picture.pixels, opaque);
}

/// Grey levels above or below the cut: positive in solid.
std::vector<float> dark_is_solid(const std::vector<Rgb8>& color, double cut) {
    std::vector<float> level(color.size());
    std::ranges::transform(color, level.begin(), [&](const Rgb8& c) { return static_cast<float>(cut) - luma(c); });
    return level;
}

double automatic_cut(const std::vector<Rgb8>& color) {
    Histogram histogram{};
    for (const Rgb8& c : color) ++histogram[to_byte(luma(c))];
    const std::optional<double> cut = otsu_threshold(histogram);
    if (!cut)
        throw InvalidInput(
            "the exemplar has the same brightness everywhere; expected dark (solid) and light (empty) parts, or a "
            "mask");
    return *cut / 255.0;
}

std::vector<float> alpha_level(const Image& picture) {
    std::vector<float> level(picture.pixels.size());
    std::ranges::transform(picture.pixels, level.begin(),
                           [](const Rgba8& c) { return static_cast<float>(c[3]) / 255.0f - 0.5f; });
    return level;
}

std::vector<float> mask_level(const Image& mask, int width, int height) {
    // A mask holds coverage, not light: as alpha it is averaged as it stands.
    Image coverage{mask.width, mask.height, {}, true};
    coverage.pixels.resize(mask.pixels.size());
    std::ranges::transform(mask.pixels, coverage.pixels.begin(), [](const Rgba8& c) -> Rgba8 {
        return {0, 0, 0, to_byte(luma(over_white(c)))};
    });
    return alpha_level(resample_image(coverage, width, height));
}

std::vector<float> solid_level(const Image& picture, const std::vector<Rgb8>& color, const Image* mask,
                               const ExemplarSettings& settings) {
    switch (settings.mask) {
        case MaskSource::kAutomatic:
            return alpha_varies(picture) ? alpha_level(picture) : dark_is_solid(color, automatic_cut(color));
        case MaskSource::kAlpha:
            if (!picture.has_alpha)
                throw InvalidInput("exemplar.mask is \"alpha\", but the picture has no alpha channel");
            return alpha_level(picture);
        case MaskSource::kThreshold:
            return dark_is_solid(color, settings.threshold);
        case MaskSource::kImage:
            if (mask == nullptr) throw InvalidInput("exemplar.mask is \"image\", but no mask picture was given");
            check_picture(*mask, "the mask");
            return mask_level(*mask, picture.width, picture.height);
    }
    throw InvalidSetting("exemplar.mask has an unknown value");
}

/// Zero counts as empty, so it must become a value above zero.
void exchange_phases(std::vector<float>& level) {
    constexpr float kJustSolid = 1e-6f;
    for (float& l : level) l = l == 0.0f ? kJustSolid : -l;
}

void check_both_phases(const Exemplar& exemplar) {
    const auto solids = std::ranges::count(exemplar.solid, std::uint8_t{1});
    if (solids == 0)
        throw InvalidInput(
            "the exemplar's mask is all empty; expected solid and empty pixels (try invert or another threshold)");
    if (static_cast<std::size_t>(solids) == exemplar.solid.size())
        throw InvalidInput(
            "the exemplar's mask is all solid; expected solid and empty pixels (try invert or another threshold)");
}

}  // namespace

double Exemplar::solid_fraction() const {
    if (solid.empty()) return 0.0;
    return static_cast<double>(std::ranges::count(solid, std::uint8_t{1})) / static_cast<double>(solid.size());
}

Exemplar make_exemplar(const Image& picture, const Image* mask, const ExemplarSettings& settings) {
    check_settings(settings);
    check_picture(picture, "the exemplar");
    const Image reduced = reduce(picture, settings.max_side_px);

    Exemplar exemplar;
    exemplar.width = reduced.width;
    exemplar.height = reduced.height;
    exemplar.color.resize(reduced.pixels.size());
    std::ranges::transform(reduced.pixels, exemplar.color.begin(), over_white);

    std::vector<float> level = solid_level(reduced, exemplar.color, mask, settings);
    if (settings.invert) exchange_phases(level);
    exemplar.solid.resize(level.size());
    std::ranges::transform(level, exemplar.solid.begin(), [](float l) { return static_cast<std::uint8_t>(l > 0); });
    check_both_phases(exemplar);

    exemplar.tileable = settings.tileable.value_or(
        is_tileable(measure_wrap_step(exemplar.color, exemplar.solid, exemplar.width, exemplar.height)));
    exemplar.feature_distance_px = signed_distance_px(level, exemplar.width, exemplar.height, exemplar.tileable);
    return exemplar;
}

}  // namespace fretwork
