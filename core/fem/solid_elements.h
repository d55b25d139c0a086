// Stage 5a: the two solid elements of the simplified beam geometry (section 5.2.1).
#pragma once

#include <Eigen/Core>
#include <array>

#include "core/fem/material.h"

namespace fretwork {

/// Stress and strain are in the paper's order: xx, yy, zz, xy, yz, xz; shear strains are the engineering ones.
using Stress = Eigen::Matrix<double, 6, 1>;
using Elasticity = Eigen::Matrix<double, 6, 6>;

/// Isotropic Hooke's law, MPa.
/// \throws InvalidSetting  E or density not positive, or a Poisson's ratio outside (-1, 0.5).
Elasticity elasticity(const Material& material);

/// Corners of an element, one per column, mm. Order of VTK: hexahedron (-,-,-) (+,-,-) (+,+,-) (-,+,-) and the same at
/// the top; wedge: bottom triangle counter-clockwise seen from the top, then the top triangle.
template <int Nodes>
using Corners = Eigen::Matrix<double, 3, Nodes>;

/// What an element contributes. Degrees of freedom: x, y, z of each corner in turn.
template <int Nodes, int Points>
struct ElementMatrices {
    static constexpr int kNodes = Nodes;
    static constexpr int kPoints = Points;
    Eigen::Matrix<double, 3 * Nodes, 3 * Nodes> stiffness;                    ///< K_e, N/mm; symmetric
    std::array<Eigen::Matrix<double, 6, 3 * Nodes>, Points> stress_operator;  ///< corners' displacements -> stress, MPa
    double volume_mm3 = 0.0;
};
using Hex8Matrices = ElementMatrices<8, 8>;
using Wedge6Matrices = ElementMatrices<6, 6>;

/// Trilinear hexahedron, 2x2x2 Gauss points, with the three incompatible bending modes of Wilson (9 internal freedoms,
/// condensed) in Taylor's form: their gradients use the Jacobian at the centre, so that distorted elements reproduce
/// constant strain exactly. Without them a hexahedron locks in bending.
/// \throws InvalidInput  a Jacobian that is not positive at a Gauss point.
Hex8Matrices hex8_matrices(const Corners<8>& corners_mm, const Elasticity& D);

/// Linear wedge, 3x2 Gauss points, with the incompatible mode of its thickness (3 internal freedoms, condensed).
/// \throws InvalidInput  a Jacobian that is not positive at a Gauss point.
Wedge6Matrices wedge6_matrices(const Corners<6>& corners_mm, const Elasticity& D);

/// Least determinant of the Jacobian over Gauss points, corners and the centre, mm^3; not positive for elements that
/// fold over.
double least_jacobian(const Corners<8>& corners_mm);
double least_jacobian(const Corners<6>& corners_mm);

/// |s1| + |s2| + |s3| over the principal stresses: the paper's score.
double principal_stress_sum(const Stress& stress);

}  // namespace fretwork
