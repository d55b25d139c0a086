// What `carve --report` shows of each carved target.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cli/carve_run.h"
#include "core/pipeline/carve.h"
#include "formats/report_html.h"

namespace fretwork::cli {

/// Pictures and the mesh of the 3D view; to be made while the engine's result is whole.
/// Cost  about six seconds of CPU for a figure of 256 voxels
/// \param carved  with its trace
/// \param most_triangles  of the 3D view
ReportViews report_views(const Exemplar& exemplar, const CarveResult& carved, std::size_t most_triangles,
                         const RunControl& run);

/// The page of all targets, each of which has its views.
std::string report_page(const CarveModel& model, const std::vector<CarvedTarget>& carved,
                        const std::vector<RunReport>& reports);

}  // namespace fretwork::cli
