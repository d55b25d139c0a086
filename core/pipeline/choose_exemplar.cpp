#include "core/pipeline/choose_exemplar.h"

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/exemplar/builtin/builtin_patterns.h"

namespace fretwork {

ExemplarSettings exemplar_settings(const ExemplarOptions& options) {
    if ((options.mask.empty() ? 0 : 1) + (options.threshold ? 1 : 0) + (options.alpha ? 1 : 0) > 1)
        throw ConstraintsNotMet("exemplar.mask, exemplar.threshold and exemplar.alpha exclude each other; leave one");
    ExemplarSettings settings;
    if (!options.mask.empty()) settings.mask = MaskSource::kImage;
    if (options.alpha) settings.mask = MaskSource::kAlpha;
    if (options.threshold) {
        settings.mask = MaskSource::kThreshold;
        settings.threshold = *options.threshold;
    }
    settings.invert = options.invert;
    settings.tileable = options.tileable;
    settings.max_side_px = options.max_side_px;
    return settings;
}

ChosenExemplar builtin_exemplar(const ExemplarOptions& options) {
    const BuiltinPattern& pattern = find_builtin(options.pattern);
    if (!options.image.empty())
        throw ConstraintsNotMet(
            fmt::format("exemplar.pattern = {} and exemplar.image = {} exclude each other; leave one", options.pattern,
                        options.image));
    if (!options.mask.empty() || options.threshold || options.alpha)
        throw ConstraintsNotMet(
            fmt::format("exemplar.pattern = {} brings its own mask; leave out exemplar.mask, threshold and alpha",
                        options.pattern));
    ChosenExemplar chosen;
    chosen.name = pattern.name;
    chosen.natural_width_mm = pattern.width_mm;
    if (!options.invert) {
        chosen.exemplar = make_builtin(pattern.name);
    } else {
        const PatternPictures pictures = draw_builtin(pattern.name);
        ExemplarSettings settings{.mask = MaskSource::kImage, .invert = true, .tileable = pattern.tileable};
        settings.max_side_px = options.max_side_px;
        chosen.exemplar = make_exemplar(pictures.color, &pictures.mask, settings);
    }
    return chosen;
}

ChosenExemplar picture_exemplar(const ExemplarOptions& options, const Image& picture, const Image* mask) {
    const ExemplarSettings settings = exemplar_settings(options);
    try {
        return {make_exemplar(picture, mask, settings), options.image, std::nullopt};
    } catch (const InvalidInput& unusable) {
        throw InvalidInput(fmt::format("{}: {}", options.image, unusable.what()));
    }
}

}  // namespace fretwork
