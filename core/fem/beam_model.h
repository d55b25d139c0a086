// Stage 5: the simplified beam geometry of one abstract graph, ready to be solved again and again.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/fem/beam_system.h"
#include "core/fem/force_profile.h"
#include "core/fem/material.h"
#include "core/graph/abstract_graph.h"

namespace fretwork {

/// Section 5.2.1. Wedges are always solid, beams have stiffness 1 or rho_min times their own. A beam's
/// own stiffness is that of its hexahedron times the width of the material it stands for
/// (`beam_widths.h`) over the width of the hexahedron, so that thin strands are as weak as they are.
class BeamModel {
  public:
    /// Builds geometry and element matrices, orders the equations. References must outlive the model.
    /// Load cases with the same supports share a factorisation. Worst cases are those of the pattern as it is now.
    /// \param half_width_voxels  of `beam_half_widths`
    /// \throws InvalidSetting  material out of range (`solid_elements.h`).
    /// \throws SolverFailure   no memory.
    BeamModel(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
              std::vector<float> half_width_voxels, const ForceProfile& profile, const Material& material,
              const BeamModelSettings& settings, const RunControl& run = {});
    ~BeamModel();
    BeamModel(BeamModel&&) noexcept;
    BeamModel& operator=(BeamModel&&) noexcept;

    /// Per edge the largest |s1| + |s2| + |s3| over its Gauss points and over all load cases, in Pa. The
    /// stress is that of the full material under the strain found (sigma = E B u), for empty edges too:
    /// what they would feel if they were not there to carry anything. A solid sliver (`beam_widths.h`) stands for no
    /// section; its score in each load case is the mean of the solid edges at its two ends, weighted by
    /// their widths.
    /// \param states  one per edge; need not be those of the graph
    /// Cost  one factorisation per set of supports, one solution per load case.
    /// \throws SolverFailure  the equations are singular.
    std::vector<double> edge_scores_pa(std::span<const EdgeState> states, const RunControl& run = {});

    /// Half of the width of the pattern around each voxel as it was when the model was built (`pattern_width.h`).
    [[nodiscard]] const std::vector<float>& half_width_voxels() const;

    /// Width of the material along an edge, mm.
    [[nodiscard]] double width_mm(EdgeIndex e) const;

    /// From now on the material along an edge is at least `least_mm` wide.
    void widen(EdgeIndex e, double least_mm);

    [[nodiscard]] std::size_t degrees_of_freedom() const;
    [[nodiscard]] std::size_t folded_beams() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
