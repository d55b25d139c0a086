#include "core/fem/frame_link.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace fretwork {
namespace {

constexpr std::array<std::array<int, 4>, 2> kEndCorners{{{0, 3, 7, 4}, {1, 2, 6, 5}}};

Eigen::Matrix3d cross_matrix(const Vec3& d) {
    Eigen::Matrix3d m;
    m << 0, -d[2], d[1], d[2], 0, -d[0], -d[1], d[0], 0;
    return m;
}

/// Least-squares rigid motion (translation of the centre, rotation) of one end's corners.
Eigen::Matrix<double, 6, 24> rigid_motion(const Corners<8>& corners, const std::array<int, 4>& end,
                                          const Vec3& center) {
    Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
    for (const int n : end) {
        const Eigen::Matrix3d arm = cross_matrix(corners.col(n) - center);
        inertia += arm.transpose() * arm;
    }
    const Eigen::Matrix3d inverse = inertia.inverse();
    Eigen::Matrix<double, 6, 24> T = Eigen::Matrix<double, 6, 24>::Zero();
    for (const int n : end) {
        T.block<3, 3>(0, 3 * n) = 0.25 * Eigen::Matrix3d::Identity();
        T.block<3, 3>(3, 3 * n) = inverse * cross_matrix(corners.col(n) - center);
    }
    return T;
}

/// Factor of torsion of a rectangle a x b, a >= b: J = a b^3 (1/3 - 0.21 b/a (1 - b^4 / 12 a^4)).
double torsion_constant(const BeamSection& s) {
    const double a = std::max(s.width_mm, s.thickness_mm);
    const double b = std::min(s.width_mm, s.thickness_mm);
    const double q = b / a;
    return a * b * b * b * (1.0 / 3.0 - 0.21 * q * (1.0 - q * q * q * q / 12.0));
}

/// Local stiffness of a straight Timoshenko beam along x; freedoms (x, y, z, rotations) at both ends.
Eigen::Matrix<double, 12, 12> timoshenko(double length, const BeamSection& s, const Material& material) {
    const double E = material.youngs_modulus_mpa;
    const double G = E / (2.0 * (1.0 + material.poissons_ratio));
    const double A = s.width_mm * s.thickness_mm;
    const double Iy = s.width_mm * std::pow(s.thickness_mm, 3) / 12.0;  // y lies across, z through the wall
    const double Iz = s.thickness_mm * std::pow(s.width_mm, 3) / 12.0;
    const double L = length;
    Eigen::Matrix<double, 12, 12> K = Eigen::Matrix<double, 12, 12>::Zero();
    const auto spring = [&](int i, double k) {
        K(i, i) += k;
        K(i + 6, i + 6) += k;
        K(i, i + 6) -= k;
        K(i + 6, i) -= k;
    };
    spring(0, E * A / L);
    spring(3, G * torsion_constant(s) / L);
    // Bending with deflection freedom `v`, rotation freedom `r`; `sign` is that of dv/dx in terms of r.
    const auto bend = [&](int v, int r, double I, double sign) {
        const double phi = 12.0 * E * I / (5.0 / 6.0 * G * A * L * L);
        const double k = E * I / (L * L * L * (1.0 + phi));
        const std::array<int, 4> dof{v, r, v + 6, r + 6};
        Eigen::Matrix4d b;
        const double h = 6.0 * L * sign;
        b << 12, h, -12, h,                                   //
            h, (4.0 + phi) * L * L, -h, (2.0 - phi) * L * L,  //
            -12, -h, 12, -h,                                  //
            h, (2.0 - phi) * L * L, -h, (4.0 + phi) * L * L;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j)
                K(dof[static_cast<std::size_t>(i)], dof[static_cast<std::size_t>(j)]) += k * b(i, j);
    };
    bend(1, 5, Iz, 1.0);
    bend(2, 4, Iy, -1.0);
    return K;
}

}  // namespace

FrameLinkMatrices frame_link_matrices(const Corners<8>& corners_mm, const Vec3& up, const BeamSection& section,
                                      const Material& material) {
    std::array<Vec3, 2> center;
    for (std::size_t end = 0; end < 2; ++end) {
        center[end].setZero();
        for (const int n : kEndCorners[end]) center[end] += 0.25 * corners_mm.col(n);
    }
    // Ends that (nearly) coincide leave no axis; a short beam across `up` is as good as any.
    Vec3 axis = center[1] - center[0];
    const double shortest = 1e-2 * std::min(section.width_mm, section.thickness_mm);
    if (axis.norm() < shortest) axis = shortest * up.unitOrthogonal();
    Eigen::Matrix3d frame;  // columns: along, across, through
    frame.col(0) = axis.normalized();
    const Vec3 across = up.cross(frame.col(0));
    frame.col(1) = across.norm() > 1e-6 ? Vec3(across.normalized()) : Vec3(frame.col(0).unitOrthogonal());
    frame.col(2) = frame.col(0).cross(frame.col(1));

    Eigen::Matrix<double, 12, 24> T;
    T.topRows<6>() = rigid_motion(corners_mm, kEndCorners[0], center[0]);
    T.bottomRows<6>() = rigid_motion(corners_mm, kEndCorners[1], center[1]);
    for (int part = 0; part < 4; ++part)
        T.middleRows<3>(3 * part) = (frame.transpose() * T.middleRows<3>(3 * part)).eval();
    const Eigen::Matrix<double, 12, 12> local = timoshenko(axis.norm(), section, material);

    FrameLinkMatrices result;
    result.stiffness = T.transpose() * local * T;
    result.stiffness = (0.5 * (result.stiffness + result.stiffness.transpose())).eval();
    result.end_forces[0] = local.topRows<6>() * T;
    result.end_forces[1] = local.bottomRows<6>() * T;
    return result;
}

double frame_link_stress_sum(const Eigen::Matrix<double, 6, 1>& forces, const BeamSection& s) {
    const double A = s.width_mm * s.thickness_mm;
    const double normal = std::abs(forces[0]) / A +
                          std::abs(forces[4]) * 6.0 / (s.width_mm * s.thickness_mm * s.thickness_mm) +
                          std::abs(forces[5]) * 6.0 / (s.thickness_mm * s.width_mm * s.width_mm);
    const double shear = std::hypot(forces[1], forces[2]) / A +
                         std::abs(forces[3]) * 0.5 * std::min(s.width_mm, s.thickness_mm) / torsion_constant(s);
    // Principal stresses of (normal, shear): normal / 2 +- sqrt((normal / 2)^2 + shear^2).
    return std::sqrt(normal * normal + 4.0 * shear * shear);
}

}  // namespace fretwork
