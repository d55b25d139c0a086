#include "core/fem/beam_system.h"

#include <algorithm>
#include <utility>

#include "core/fem/facing_sheets.h"

namespace fretwork {
namespace {

/// Factor that turns a hexahedron's stiffness into that of a strand as wide as the pattern is. Held
/// within bounds: beyond them the geometry, not the factor, is wrong.
double width_factor(double pattern_mm, double beam_mm) {
    return std::clamp(pattern_mm / beam_mm, 0.1, 10.0);
}

BeamWedgeMesh mesh_of(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                      const BeamWidths& widths, const BeamModelSettings& settings, const RunControl& run) {
    BeamGeometry geometry;
    geometry.thickness_mm = settings.thickness_mm;
    BeamWedgeMesh mesh = build_beam_wedge_mesh(shell, graph, widths.at_sample_voxels, geometry);
    add_ties(sheet_ties(shell, solid, graph, settings.facing), mesh);
    run.throw_if_stopped();
    return mesh;
}

}  // namespace

BeamSystem::BeamSystem(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                       std::vector<float> half_width_voxels, const Material& material,
                       const BeamModelSettings& settings, const RunControl& run)
    : BeamSystem(shell, solid, graph,
                 beam_widths(shell, solid, graph, std::move(half_width_voxels), settings.bridge_half_width_voxels),
                 material, settings, run) {}

BeamSystem::BeamSystem(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                       BeamWidths widths_in, const Material& material, const BeamModelSettings& settings,
                       const RunControl& run)
    : mesh(mesh_of(shell, solid, graph, widths_in, settings, run)),
      elements(mesh, material, settings.thickness_mm),
      widths(std::move(widths_in)),
      soft_factor_(settings.soft_factor) {
    for (EdgeIndex e = 0; e < graph.edges.size(); ++e)
        width_factors_.push_back(width_factor(widths.along_edge_mm[e], mesh.beams[e].width_mm));
}

std::vector<double> BeamSystem::factors(std::span<const EdgeState> states) const {
    std::vector<double> result(states.size());
    for (std::size_t e = 0; e < states.size(); ++e)
        result[e] = width_factors_[e] * (states[e] == EdgeState::kSolid ? 1.0 : soft_factor_);
    return result;
}

void BeamSystem::widen(EdgeIndex e, double least_mm) {
    double& width_mm = widths.along_edge_mm[e];
    width_mm = std::max(width_mm, least_mm);
    width_factors_[e] = width_factor(width_mm, mesh.beams[e].width_mm);
}

}  // namespace fretwork
