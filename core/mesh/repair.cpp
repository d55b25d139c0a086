#include "core/mesh/repair.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/mesh/check_mesh.h"
#include "core/mesh/repair_steps.h"

namespace fretwork {
namespace {

double longest_side(const TriangleMesh& mesh) {
    Vec3 low = mesh.positions_mm[mesh.triangles[0][0]], high = low;
    for (const Triangle& t : mesh.triangles)
        for (const std::uint32_t v : t) {
            low = low.cwiseMin(mesh.positions_mm[v]);
            high = high.cwiseMax(mesh.positions_mm[v]);
        }
    return (high - low).maxCoeff();
}

std::string counted(std::size_t count, const char* one, const char* many) {
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

}  // namespace

RepairedMesh repair_mesh(const TriangleMesh& mesh, const RepairSettings& settings, const RunControl& run) {
    if (!(settings.weld_mm >= 0.0) || !std::isfinite(settings.weld_mm))
        throw InvalidSetting("repair: weld_mm is " + std::to_string(settings.weld_mm) +
                             "; expected a length of at least 0 mm");
    check_mesh(mesh, "repair");
    const double extent = longest_side(mesh);
    repair::Draft draft{mesh, std::vector<std::uint32_t>(mesh.triangles.size()), {}, run};
    for (std::uint32_t t = 0; t < draft.source.size(); ++t) draft.source[t] = t;

    run.checkpoint("repair", 0.0);
    repair::weld_equal_positions(draft);
    run.checkpoint("repair", 0.2);
    repair::weld_borders(draft, settings.weld_mm > 0.0 ? settings.weld_mm : 1e-6 * extent);
    repair::drop_degenerate(draft);
    if (draft.mesh.triangles.empty())
        throw InvalidInput("repair: all " + std::to_string(mesh.triangles.size()) + " triangles have zero area");
    run.checkpoint("repair", 0.4);
    repair::drop_duplicates(draft);
    run.checkpoint("repair", 0.5);
    repair::agree_on_turn(draft);
    run.checkpoint("repair", 0.6);
    std::vector<HalfEdge> mates = repair::glue_half_edges(draft);
    run.checkpoint("repair", 0.7);
    repair::separate_sheets(draft, std::move(mates));
    run.checkpoint("repair", 0.8);
    repair::turn_outward(draft, EdgeTable(draft.mesh, run));
    run.checkpoint("repair", 1.0);
    return {std::move(draft.mesh), std::move(draft.source), draft.counts};
}

std::vector<std::string> describe(const RepairCounts& counts) {
    std::vector<std::string> lines;
    const auto say = [&](std::size_t count, const char* one, const char* many) {
        if (count > 0) lines.push_back(counted(count, one, many));
    };
    say(counts.border_welds, "border vertex was moved onto a neighbour to close a crack",
        "border vertices were moved onto neighbours to close cracks");
    say(counts.degenerate_triangles, "triangle without area was dropped", "triangles without area were dropped");
    say(counts.duplicate_triangles, "duplicate triangle was dropped", "duplicate triangles were dropped");
    say(counts.inner_wall_triangles, "triangle of a wall inside the material was dropped",
        "triangles of walls inside the material were dropped");
    say(counts.turned_triangles, "triangle was turned to agree with its neighbours",
        "triangles were turned to agree with their neighbours");
    say(counts.non_manifold_edges, "edge with more than two triangles was taken apart",
        "edges with more than two triangles were taken apart");
    say(counts.one_sided_edges, "edge was cut because the surface has only one side there",
        "edges were cut because the surface has only one side there");
    say(counts.split_vertices, "vertex was doubled where sheets touch", "vertices were doubled where sheets touch");
    say(counts.inverted_components, "piece was inside out and was turned", "pieces were inside out and were turned");
    if (counts.open_components > 0)
        lines.push_back(counted(counts.open_components, "piece is", "pieces are") + " open, with " +
                        counted(counts.border_edges, "border edge", "border edges"));
    return lines;
}

}  // namespace fretwork
