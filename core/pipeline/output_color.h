// `output.colour` -> what the carved mesh carries.
#pragma once

#include <vector>

#include "core/exemplar/exemplar.h"
#include "core/exemplar/image.h"
#include "core/pipeline/settings.h"

namespace fretwork {

/// Colours as asked: unchanged, one colour for all, or emptied.
std::vector<Rgb8> output_colors(std::vector<Rgb8> colors, OutputColor wanted, const Exemplar& exemplar);

}  // namespace fretwork
