// The run report as JSON; docs/report.schema.json describes it.
#pragma once

#include <string>

#include "core/pipeline/run_report.h"

namespace fretwork {

enum class ReportTimes {
    kInclude,
    kLeaveOut,  ///< no seconds, no memory: the same run always gives the same text
};

/// One object, keys in the order of the schema, two blanks per level, a line break at the end.
std::string report_json(const RunReport& report, ReportTimes times = ReportTimes::kInclude);

}  // namespace fretwork
