// What a printer and the pattern will make of a run's numbers, told before the run.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/resolve_settings.h"
#include "core/pipeline/settings.h"

namespace fretwork {

/// One sentence for each thing that works but not as one would wish, with both numbers and what to change: strokes and
/// openings of the picture that are narrower than what is kept of them, a wall or layers that the nozzle prints badly,
/// a pattern that hardly repeats on the model. Empty where nothing is foreseen.
/// \param resolved  of the full run, not of a draft
std::vector<std::string> foreseen(const ResolvedSettings& resolved, const ExemplarFacts& exemplar,
                                  const FabricationOptions& fabrication, double synthesis_scale);

}  // namespace fretwork
