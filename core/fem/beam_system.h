// Stage 5b: geometry, element matrices and widths of an abstract graph: all of the beam model but what it stands on.
#pragma once

#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/fem/beam_elements.h"
#include "core/fem/beam_wedge_mesh.h"
#include "core/fem/beam_widths.h"
#include "core/fem/material.h"
#include "core/graph/abstract_graph.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct BeamModelSettings {
    double thickness_mm = 2.0;              ///< final wall
    double soft_factor = 1e-3;              ///< rho_min, of empty edges
    double bridge_half_width_voxels = 3.0;  ///< of an edge that is empty now, once it is solid: r_pattern
    /// Of `facing_voxels`: where walls of opposite sheets have grown together, their samples are tied. Empty: nowhere.
    std::vector<VoxelIndex> facing;
};

class BeamSystem {
  public:
    /// \param half_width_voxels  of `beam_half_widths`
    /// \throws InvalidSetting  material out of range (`solid_elements.h`).
    BeamSystem(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
               std::vector<float> half_width_voxels, const Material& material, const BeamModelSettings& settings,
               const RunControl& run = {});

    /// Factors on the beams' own stiffness: their width over that of the hexahedron, and rho_min where empty.
    [[nodiscard]] std::vector<double> factors(std::span<const EdgeState> states) const;

    /// From now on the material along an edge is at least `least_mm` wide.
    void widen(EdgeIndex e, double least_mm);

    BeamWedgeMesh mesh;
    BeamElements elements;
    BeamWidths widths;

  private:
    BeamSystem(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph, BeamWidths widths_in,
               const Material& material, const BeamModelSettings& settings, const RunControl& run);

    double soft_factor_;
    std::vector<double> width_factors_;  ///< per edge
};

}  // namespace fretwork
