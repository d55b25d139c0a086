// The targets of a model, carved one after the other.
#pragma once

#include <optional>
#include <vector>

#include "cli/carve_model.h"
#include "cli/picture_files.h"
#include "core/pipeline/carve.h"
#include "formats/report_html.h"
#include "formats/voxel_sheets.h"

namespace fretwork::cli {

/// What is kept of a carved target until all are written.
struct CarvedTarget {
    TriangleMesh mesh;
    std::vector<Rgb8> triangle_colors;
    std::optional<VoxelSheets> sheets;
    std::vector<std::uint8_t> extruders;  ///< one per triangle; empty where nothing is painted
    RunReport report;
    std::optional<ReportViews> views;  ///< only if they were asked for
};

enum class KeepViews { kNo, kYes };

/// One per target, each with its own settings (`[[object]]`). The meshes of the targets are used up.
/// \param views  whether to make what a report shows of each
/// \throws  see carve; messages name the model and, if there are several, the object.
std::vector<CarvedTarget> carve_targets(CarveModel& model, const Settings& settings, PictureFiles& pictures,
                                        const RunLimits& limits, KeepViews views, const RunControl& run);

/// Gives every triangle the extruder of the palette that stands best for all targets together, and notes it in the
/// reports. Does nothing where `output.paint` asks for nothing.
/// \throws ConstraintsNotMet  there are no colours to paint.
void paint_targets(std::vector<CarvedTarget>& carved, const OutputOptions& output);

/// The same for check_carve.
std::vector<RunReport> check_targets(CarveModel& model, const Settings& settings, PictureFiles& pictures,
                                     const RunLimits& limits, const RunControl& run);

/// "lid" or "object 3"; what messages call a target.
std::string label_of(const CarveTarget& target);

}  // namespace fretwork::cli
