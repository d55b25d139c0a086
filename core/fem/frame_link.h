// Stage 5a: what stands for a hexahedral beam that would fold over.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/base/vec.h"
#include "core/fem/material.h"
#include "core/fem/solid_elements.h"

namespace fretwork {

/// Section of a beam: rectangle, `width_mm` in the surface and `thickness_mm` through it.
struct BeamSection {
    double width_mm = 0.0;
    double thickness_mm = 0.0;
};

struct FrameLinkMatrices {
    Eigen::Matrix<double, 24, 24> stiffness;  ///< N/mm
    /// Corners' displacements -> (normal force, shear y, shear z, torque, moment about y and z) at either end: N, N mm.
    std::array<Eigen::Matrix<double, 6, 24>, 2> end_forces;
};

/// A Timoshenko beam between the centres of the two ends of a hexahedron; each end follows the best
/// rigid motion of its four corners. Any position of the corners will do: the ends may overlap,
/// face away from each other or be twisted.
///
/// \param corners_mm  as for hex8_matrices; the ends are corners 0 3 7 4 and 1 2 6 5
/// \param up          direction of the thickness, about perpendicular to the beam
FrameLinkMatrices frame_link_matrices(const Corners<8>& corners_mm, const Vec3& up, const BeamSection& section,
                                      const Material& material);

/// |s1| + |s2| + |s3| at the worst place of the section: tension with both bendings at a corner, with
/// the mean shear and the torsion. `forces` are those of one end, MPa out.
double frame_link_stress_sum(const Eigen::Matrix<double, 6, 1>& forces, const BeamSection& section);

}  // namespace fretwork
