// The run report as JSON; docs/report.schema.json describes it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "core/pipeline/run_report.h"

namespace fretwork {

enum class ReportTimes {
    kInclude,
    kLeaveOut,  ///< no seconds, no memory: the same run always gives the same text
};

/// One of several objects of a 3MF and what became of it.
struct ObjectReport {
    std::string name;
    std::string part_number;
    std::string part;  ///< model part of the package that holds it
    std::uint32_t id = 0;
    std::size_t instances = 1;
    const RunReport& report;
};

/// One object, keys in the order of the schema, two blanks per level, a line break at the end.
std::string report_json(const RunReport& report, ReportTimes times = ReportTimes::kInclude);

/// The same for a 3MF: of the first object as it is alone, and `objects`, which lists all. \param objects  at least one
std::string report_json(std::span<const ObjectReport> objects, ReportTimes times = ReportTimes::kInclude);

}  // namespace fretwork
