// The model as it was read -> the surface that is carved.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/mesh_report.h"
#include "core/mesh/triangle_mesh.h"
#include "core/pipeline/settings.h"

namespace fretwork {

struct PreparedSurface {
    TriangleMesh mesh;                            ///< turned, scaled and repaired
    std::vector<std::uint32_t> source_triangles;  ///< triangle of the input that each triangle is part of
    bool open = false;                            ///< has border edges
    double scale = 1.0;                           ///< factor on the model's coordinates
    MeshReport found;                             ///< of the turned and scaled mesh before its repair
    std::vector<std::string> warnings;            ///< what was wrong and what was done, with counts
};

/// Where a point of the model's file is on the surface that is carved. Quarter and half turns only, so that
/// coordinates stay exact.
Vec3 in_model_mm(const Vec3& file_point, UpAxis up, double scale);

/// \param count  whether to look for self-intersections, which takes most of the time and changes nothing but the
///               report and the warnings
/// \throws InvalidInput       no usable triangle.
/// \throws ConstraintsNotMet  see input_scale.
PreparedSurface prepare_surface(const TriangleMesh& mesh, const InputOptions& input,
                                CountSelfIntersections count = CountSelfIntersections::kYes,
                                const RunControl& run = {});

}  // namespace fretwork
