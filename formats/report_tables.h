// Verdicts and tables of a report as HTML.
#pragma once

#include <string>
#include <vector>

#include "core/pipeline/carve_trace.h"
#include "core/pipeline/run_report.h"

namespace fretwork {

/// One piece, valid mesh, stress, print: each as good or bad.
std::string verdicts(const RunReport& report);

std::string stress_table(const ShellStress& stress);
std::string iteration_table(const std::vector<ReinforceRecord>& turns);

std::string width_section(const RunReport& report);
/// Says so where a draft did without.
std::string printability_section(const RunReport& report);
std::string mesh_section(const RunReport& report);
std::string pattern_section(const RunReport& report);
std::string settings_section(const RunReport& report);
/// All that differs between two runs of the same input: `<section class="times">`.
std::string times_section(const RunReport& report);

}  // namespace fretwork
