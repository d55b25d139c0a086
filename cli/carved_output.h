// Carved results as the bytes of files.
#pragma once

#include <string>
#include <vector>

#include "cli/carve_run.h"
#include "core/base/run_control.h"
#include "formats/mesh_file.h"
#include "formats/report_json.h"
#include "formats/run_source.h"
#include "formats/threemf_editor.h"

namespace fretwork::cli {

/// What is written together; references must outlive the calls.
struct CarvedModel {
    const CarveModel& model;
    const std::vector<CarvedTarget>& carved;  ///< one per target
    const Settings& settings;
    const std::vector<RunFile>& pictures;
    const ThreemfEditor* package = nullptr;  ///< where the model is a 3MF, opened for its targets in their order
};

/// 3MF with colours, voxel data, picture, resolved spec, report and what it takes to run again; the other formats with
/// what they can hold. A 3MF that comes from a 3MF holds everything else of that too. The same input, settings and
/// seed always give the same bytes.
/// \param path  where it will go
MeshBytes carved_bytes(const CarvedModel& result, const std::string& path, MeshFormat format, const RunControl& run);

/// A picture of the whole result.
std::string preview_png(const CarvedModel& result, const RunControl& run);

std::string summary_json(const CarveModel& model, const std::vector<RunReport>& reports, ReportTimes times);

}  // namespace fretwork::cli
