// `[exemplar]` -> the exemplar of a run.
#pragma once

#include <optional>
#include <string>

#include "core/exemplar/exemplar.h"
#include "core/pipeline/settings.h"

namespace fretwork {

struct ChosenExemplar {
    Exemplar exemplar;
    std::string name;
    std::optional<double> natural_width_mm;
};

/// What `mask`, `threshold` and `alpha` ask for.
/// \throws ConstraintsNotMet  more than one of them is given.
ExemplarSettings exemplar_settings(const ExemplarOptions& options);

/// The built-in pattern that `options.pattern` names.
/// \throws InvalidSetting     unknown name.
/// \throws ConstraintsNotMet  a mask, threshold or alpha beside it; both a pattern and an image.
ChosenExemplar builtin_exemplar(const ExemplarOptions& options);

/// \param picture  the contents of `options.image`
/// \param mask     the contents of `options.mask`; null where none is named
/// \throws InvalidInput  the picture or its mask cannot be used; names the file.
ChosenExemplar picture_exemplar(const ExemplarOptions& options, const Image& picture, const Image* mask);

}  // namespace fretwork
