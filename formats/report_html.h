// A run as one HTML page that needs nothing else: pictures, charts, tables and a 3D view.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/exemplar/image.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/carve_trace.h"
#include "core/pipeline/run_report.h"
#include "core/pipeline/stress_scale.h"
#include "formats/report_json.h"

namespace fretwork {

/// A picture of the page, ready to be shown.
struct ReportPicture {
    std::string media_type;  ///< "image/jpeg", "image/png"
    std::string bytes;
    std::string title, caption;  ///< plain text
    std::string alt;             ///< what it shows, for those who do not see it
};

/// The carved mesh of the 3D view, with what is known of each triangle. Stress is a place on the scale in 1 .. 255; 0
/// where none is known.
struct ReportMesh {
    TriangleMesh mesh;
    std::vector<Rgb8> vertex_colors;  ///< of the pattern, one per vertex
    std::vector<std::uint8_t> bridge;
    std::vector<std::uint8_t> stress_before, stress_after;
};

/// What the page shows beside the run report, made while the run still has all its data.
struct ReportViews {
    std::vector<ReportPicture> steps;     ///< exemplar, initial synthesis, bridges, final pattern
    std::vector<ReportPicture> stresses;  ///< before, after
    ReportMesh model;
    ShellStress stress;
};

struct ReportObject {
    std::string name;  ///< shown where there are several
    const RunReport& report;
    const ReportViews& views;
};

/// Everything from outside is escaped; a content policy in the page forbids every request. The same run gives the same
/// bytes, but for what stands in the section of times, which `times` can leave out.
/// Size  three quarters of a megabyte for a model of 40,000 triangles and six pictures of 560 pixels
/// \param objects  at least one
/// \throws InvalidInput  facts of a mesh that do not match its triangles
std::string report_html(std::span<const ReportObject> objects, ReportTimes times = ReportTimes::kInclude);

}  // namespace fretwork
