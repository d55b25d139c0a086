// Stage 10b: the one element matrix of all voxels, and its form in symmetric modes. Internal to this folder and its
// tests.
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/fem/material.h"
#include "core/fem/solid_elements.h"

namespace fretwork {

/// A cube is the same seen in the three mirrors. In sums and differences of its corners (the eight sign patterns of a
/// Hadamard transform) the 24 x 24 stiffness falls apart into eight blocks of 3 x 3: block p couples sign pattern
/// p ^ 1 of x, p ^ 2 of y and p ^ 4 of z. That is a quarter of the arithmetic, and exact.
struct CubeElement {
    Eigen::Matrix<double, 24, 24> stiffness;     ///< N/mm; corners in the order of VTK
    Eigen::Matrix<double, 6, 24> center_stress;  ///< corners' displacements -> stress in the middle, MPa
    std::array<Eigen::Matrix3d, 8> blocks;       ///< with the transform applied before and after
    double volume_mm3 = 0.0;
};

/// hex8_matrices of a cube: incompatible modes, which add no stress in the middle.
CubeElement cube_element(double edge_mm, const Material& material);

/// Corner of VTK -> bits x, y, z of where it is.
inline constexpr std::array<std::size_t, 8> kCornerBits{0, 1, 3, 2, 4, 5, 7, 6};

}  // namespace fretwork
