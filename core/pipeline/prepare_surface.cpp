#include "core/pipeline/prepare_surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/mesh/repair.h"
#include "core/mesh/self_intersections.h"
#include "core/pipeline/resolve_settings.h"

namespace fretwork {
namespace {

Vec3 turned_up(const Vec3& p, UpAxis up) {
    switch (up) {
        case UpAxis::kX:
            return {-p[2], p[1], p[0]};
        case UpAxis::kY:
            return {p[0], -p[2], p[1]};
        case UpAxis::kZ:
            break;
        case UpAxis::kMinusX:
            return {p[2], p[1], -p[0]};
        case UpAxis::kMinusY:
            return {p[0], p[2], -p[1]};
        case UpAxis::kMinusZ:
            return {p[0], -p[1], -p[2]};
    }
    return p;
}

}  // namespace

Vec3 in_model_mm(const Vec3& file_point, UpAxis up, double scale) {
    return scale * turned_up(file_point, up);
}

PreparedSurface prepare_surface(const TriangleMesh& mesh, const InputOptions& input, CountSelfIntersections count,
                                const RunControl& run) {
    PreparedSurface surface;
    surface.scale = input_scale(mesh, input);
    TriangleMesh scaled = mesh;
    for (Vec3& p : scaled.positions_mm) p = in_model_mm(p, input.up, surface.scale);

    RepairedMesh repaired = repair_mesh(scaled, {}, run.slice(0.0, 0.4));
    surface.found = report_mesh(scaled, CountSelfIntersections::kNo, run.slice(0.4, 0.5));
    if (count == CountSelfIntersections::kYes) {
        surface.found.self_intersections =
            find_self_intersections(repaired.mesh, run.slice(0.5, 1.0), JoinedBy::kPosition).size();
        surface.found.self_intersections_counted = true;
    }
    surface.warnings = describe(repaired.counts);
    if (surface.found.self_intersections > 0)
        surface.warnings.push_back(
            fmt::format("the model intersects itself in {} pairs of triangles", surface.found.self_intersections));
    surface.open = repaired.counts.border_edges > 0;
    surface.mesh = std::move(repaired.mesh);
    surface.source_triangles = std::move(repaired.source_triangles);
    return surface;
}

}  // namespace fretwork
