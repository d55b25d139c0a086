// Named starting points for the settings of the synthesis.
#pragma once

#include <string_view>

#include "core/synthesis/synthesizer.h"

namespace fretwork {

enum class SynthesisPreset {
    kDefault,  ///< the best looks for their time
    kFine,     ///< slower, for final results
    kPaper,    ///< the parameters of section 6.1 of the paper, no more and no less
};

SynthesisSettings synthesis_settings(SynthesisPreset preset);

}  // namespace fretwork
