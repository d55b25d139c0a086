// Charts of a report as SVG that stands within an HTML page and takes its colours from there.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/carve_trace.h"
#include "core/pipeline/run_report.h"
#include "core/pipeline/stress_scale.h"

namespace fretwork {

/// Shares of the samples per class of stress, before and after, on the same logarithmic axis.
std::string stress_histogram(const ShellStress& stress, const StressScale& scale);

/// What each turn of Algorithm 1 met and did: pieces, highest stress and voxels added, one panel each.
std::string iteration_chart(const std::vector<ReinforceRecord>& turns);

/// The colours of a scale with its numbers.
std::string stress_legend(const StressScale& scale);

}  // namespace fretwork
