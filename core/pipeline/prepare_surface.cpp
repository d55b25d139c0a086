#include "core/pipeline/prepare_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/mesh/repair.h"
#include "core/mesh/self_intersections.h"
#include "core/pipeline/resolve_settings.h"

namespace fretwork {

PreparedSurface prepare_surface(const TriangleMesh& mesh, const InputOptions& input, const RunControl& run) {
    PreparedSurface surface;
    surface.scale = input_scale(mesh, input);
    TriangleMesh scaled = mesh;
    if (surface.scale != 1.0)
        for (Vec3& p : scaled.positions_mm) p *= surface.scale;

    RepairedMesh repaired = repair_mesh(scaled, {}, run.slice(0.0, 0.4));
    surface.found = report_mesh(scaled, CountSelfIntersections::kNo, run.slice(0.4, 0.5));
    surface.found.self_intersections = find_self_intersections(repaired.mesh, run.slice(0.5, 1.0)).size();
    surface.found.self_intersections_counted = true;
    surface.warnings = describe(repaired.counts);
    if (surface.found.self_intersections > 0)
        surface.warnings.push_back(
            fmt::format("the model intersects itself in {} pairs of triangles", surface.found.self_intersections));
    if (repaired.counts.border_edges > 0)
        surface.warnings.push_back(fmt::format("the model is open: {} border edges", repaired.counts.border_edges));
    surface.open = repaired.counts.border_edges > 0;
    surface.mesh = std::move(repaired.mesh);
    surface.source_triangles = std::move(repaired.source_triangles);
    return surface;
}

}  // namespace fretwork
