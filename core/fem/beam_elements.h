// Stage 5b: element matrices of a whole beam-wedge mesh.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "core/fem/beam_wedge_mesh.h"
#include "core/fem/frame_link.h"
#include "core/fem/material.h"
#include "core/fem/stiffness_pattern.h"

namespace fretwork {

/// Elements are numbered wedges first, then beams, then ties: element wedges() + e is the beam of edge e.
class BeamElements {
  public:
    /// Cost: about 20 microseconds per element; parallel.
    BeamElements(const BeamWedgeMesh& mesh, const Material& material, double thickness_mm);

    [[nodiscard]] std::size_t wedges() const { return wedge_stiffness_.size(); }
    [[nodiscard]] std::size_t beams() const { return beam_stiffness_.size(); }
    [[nodiscard]] const ElementNodes& nodes() const { return nodes_; }

    /// Adds all elements, beams with their factor. Serial, in order, so that sums do not depend on threads.
    void assemble(const StiffnessPattern& pattern, std::span<const double> beam_factors,
                  std::span<double> values) const;

    /// |s1| + |s2| + |s3| in MPa for the displacements (24) of a beam's corners; largest over its Gauss points.
    [[nodiscard]] double beam_score_mpa(std::size_t beam, const Eigen::Matrix<double, 24, 1>& displacements_mm) const;

    /// Stress at the Gauss points, six rows each, for the displacements of the beam's corners.
    using StressOperators = Eigen::Matrix<double, 48, 24>;
    [[nodiscard]] const StressOperators& stress_operators(std::size_t beam) const { return beam_stress_[beam]; }

    /// Folds, so that a frame link stands for it: its operators give forces of its two ends instead.
    [[nodiscard]] bool is_link(std::size_t beam) const { return is_link_[beam] != 0; }

  private:
    using WedgeStiffness = Eigen::Matrix<double, 18, 18>;
    using BeamStiffness = Eigen::Matrix<double, 24, 24>;

    ElementNodes nodes_;
    std::vector<WedgeStiffness> wedge_stiffness_;
    std::vector<BeamStiffness> beam_stiffness_;
    std::vector<StressOperators> beam_stress_;
    std::vector<BeamStiffness> tie_stiffness_;
    std::vector<BeamSection> section_;
    std::vector<std::uint8_t> is_link_;  ///< per beam
};

}  // namespace fretwork
