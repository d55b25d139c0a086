#include "core/fem/solid_elements.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace fretwork {
namespace {

using Vec3d = Eigen::Vector3d;

struct QuadraturePoint {
    Vec3d at;
    double weight;
};

const double kGauss = 1.0 / std::sqrt(3.0);

struct Hex8 {
    static constexpr int kNodes = 8;
    static constexpr int kModes = 3;
    static constexpr int kPoints = 8;

    static Vec3d corner(int n) {
        static constexpr std::array<std::array<int, 3>, 8> kCorner{
            {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};
        const auto& c = kCorner[static_cast<std::size_t>(n)];
        return {static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])};
    }
    static Vec3d center() { return Vec3d::Zero(); }
    static std::array<QuadraturePoint, kPoints> points() {
        std::array<QuadraturePoint, kPoints> result;
        for (int n = 0; n < kPoints; ++n) result[static_cast<std::size_t>(n)] = {kGauss * corner(n), 1.0};
        return result;
    }
    /// Gradients of the shape functions (1 + xi xi_n)(1 + eta eta_n)(1 + zeta zeta_n) / 8.
    static Corners<8> gradients(const Vec3d& x) {
        Corners<8> g;
        for (int n = 0; n < 8; ++n) {
            const Vec3d c = corner(n);
            const Vec3d f = Vec3d::Ones() + c.cwiseProduct(x);
            g.col(n) = 0.125 * Vec3d(c[0] * f[1] * f[2], c[1] * f[0] * f[2], c[2] * f[0] * f[1]);
        }
        return g;
    }
    /// Gradients of 1 - xi^2, 1 - eta^2, 1 - zeta^2.
    static Eigen::Matrix<double, 3, kModes> mode_gradients(const Vec3d& x) { return (-2.0 * x).asDiagonal(); }
};

struct Wedge6 {
    static constexpr int kNodes = 6;
    static constexpr int kModes = 1;
    static constexpr int kPoints = 6;

    static Vec3d corner(int n) {
        const double z = n < 3 ? -1.0 : 1.0;
        return {n % 3 == 1 ? 1.0 : 0.0, n % 3 == 2 ? 1.0 : 0.0, z};
    }
    static Vec3d center() { return {1.0 / 3.0, 1.0 / 3.0, 0.0}; }
    static std::array<QuadraturePoint, kPoints> points() {
        std::array<QuadraturePoint, kPoints> result;
        for (int n = 0; n < kPoints; ++n) {
            const Vec3d c = corner(n);
            // Three interior points of the triangle, each with a third of its area 1/2; two along the thickness.
            result[static_cast<std::size_t>(n)] = {Vec3d(1.0 / 6 + 0.5 * c[0], 1.0 / 6 + 0.5 * c[1], kGauss * c[2]),
                                                   1.0 / 6};
        }
        return result;
    }
    /// Gradients of L_n (1 + zeta zeta_n) / 2 with L = (1 - r - s, r, s).
    static Corners<6> gradients(const Vec3d& x) {
        static const std::array<Eigen::Vector2d, 3> kArea{{{-1.0, -1.0}, {1.0, 0.0}, {0.0, 1.0}}};
        const std::array<double, 3> L{1.0 - x[0] - x[1], x[0], x[1]};
        Corners<6> g;
        for (int n = 0; n < 6; ++n) {
            const auto t = static_cast<std::size_t>(n % 3);
            const double z = n < 3 ? -1.0 : 1.0;
            const double f = 0.5 * (1.0 + z * x[2]);
            g.col(n) = Vec3d(kArea[t][0] * f, kArea[t][1] * f, 0.5 * z * L[t]);
        }
        return g;
    }
    /// Gradient of 1 - zeta^2.
    static Eigen::Matrix<double, 3, kModes> mode_gradients(const Vec3d& x) { return Vec3d(0.0, 0.0, -2.0 * x[2]); }
};

/// Strain operator of functions with the given gradients in space: three columns per function.
template <int N>
Eigen::Matrix<double, 6, 3 * N> strain_operator(const Eigen::Matrix<double, 3, N>& g) {
    Eigen::Matrix<double, 6, 3 * N> B = Eigen::Matrix<double, 6, 3 * N>::Zero();
    for (int n = 0; n < N; ++n) {
        const double x = g(0, n), y = g(1, n), z = g(2, n);
        B(0, 3 * n) = x;
        B(1, 3 * n + 1) = y;
        B(2, 3 * n + 2) = z;
        B(3, 3 * n) = y;
        B(3, 3 * n + 1) = x;
        B(4, 3 * n + 1) = z;
        B(4, 3 * n + 2) = y;
        B(5, 3 * n) = z;
        B(5, 3 * n + 2) = x;
    }
    return B;
}

/// d x / d xi, one column per direction of the reference element.
template <class Shape>
Eigen::Matrix3d jacobian(const Corners<Shape::kNodes>& corners, const Vec3d& at) {
    return corners * Shape::gradients(at).transpose();
}

template <class Shape>
ElementMatrices<Shape::kNodes, Shape::kPoints> integrate(const Corners<Shape::kNodes>& corners, const Elasticity& D) {
    constexpr int kOuter = 3 * Shape::kNodes;
    constexpr int kInner = 3 * Shape::kModes;
    const Eigen::Matrix3d J0 = jacobian<Shape>(corners, Shape::center());
    const Eigen::Matrix3d to_space0 = J0.inverse().transpose();
    const double det0 = J0.determinant();

    ElementMatrices<Shape::kNodes, Shape::kPoints> result;
    Eigen::Matrix<double, kInner, kOuter> K_io = Eigen::Matrix<double, kInner, kOuter>::Zero();
    Eigen::Matrix<double, kInner, kInner> K_ii = Eigen::Matrix<double, kInner, kInner>::Zero();
    std::array<Eigen::Matrix<double, 6, kOuter>, Shape::kPoints> B;
    std::array<Eigen::Matrix<double, 6, kInner>, Shape::kPoints> G;
    result.stiffness.setZero();
    const auto points = Shape::points();
    for (std::size_t p = 0; p < points.size(); ++p) {
        const Vec3d& at = points[p].at;
        const Eigen::Matrix3d J = jacobian<Shape>(corners, at);
        const double det = J.determinant();
        if (!(det > 0.0))
            throw InvalidInput("solid element: Jacobian " + std::to_string(det) + " at Gauss point " +
                               std::to_string(p) + "; expected a positive one");
        B[p] = strain_operator<Shape::kNodes>(J.inverse().transpose() * Shape::gradients(at));
        // Taylor, Beresford and Wilson 1976: with the centre's Jacobian, and det0 / det, these strains integrate to
        // zero over any element, so that they do no work in a state of constant stress.
        G[p] = strain_operator<Shape::kModes>((det0 / det) * to_space0 * Shape::mode_gradients(at));
        const double volume = det * points[p].weight;
        const Eigen::Matrix<double, 6, kOuter> DB = D * B[p];
        result.stiffness += volume * B[p].transpose() * DB;
        K_io += volume * G[p].transpose() * DB;
        K_ii += volume * G[p].transpose() * (D * G[p]);
        result.volume_mm3 += volume;
    }
    // Static condensation: the internal freedoms follow the corners as a = -K_ii^-1 K_io u.
    const Eigen::Matrix<double, kInner, kOuter> follow = -K_ii.ldlt().solve(K_io);
    result.stiffness += K_io.transpose() * follow;
    result.stiffness = (0.5 * (result.stiffness + result.stiffness.transpose())).eval();
    for (std::size_t p = 0; p < points.size(); ++p) result.stress_operator[p] = D * (B[p] + G[p] * follow);
    return result;
}

template <class Shape>
double least_determinant(const Corners<Shape::kNodes>& corners) {
    double least = jacobian<Shape>(corners, Shape::center()).determinant();
    for (const QuadraturePoint& p : Shape::points())
        least = std::min(least, jacobian<Shape>(corners, p.at).determinant());
    for (int n = 0; n < Shape::kNodes; ++n)
        least = std::min(least, jacobian<Shape>(corners, Shape::corner(n)).determinant());
    return least;
}

}  // namespace

Elasticity elasticity(const Material& material) {
    const double E = material.youngs_modulus_mpa;
    const double nu = material.poissons_ratio;
    if (!(E > 0.0) || !(material.density_kg_m3 > 0.0) || !(nu > -1.0 && nu < 0.5))
        throw InvalidSetting("material " + std::string(material.name) + ": E " + std::to_string(E) +
                             " MPa, Poisson's ratio " + std::to_string(nu) + ", density " +
                             std::to_string(material.density_kg_m3) +
                             " kg/m3; expected E and density > 0 and a ratio between -1 and 0.5");
    const double lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
    const double mu = E / (2.0 * (1.0 + nu));
    Elasticity D = Elasticity::Zero();
    D.topLeftCorner<3, 3>().setConstant(lambda);
    D.topLeftCorner<3, 3>().diagonal().array() += 2.0 * mu;
    D.bottomRightCorner<3, 3>().diagonal().setConstant(mu);
    return D;
}

Hex8Matrices hex8_matrices(const Corners<8>& corners_mm, const Elasticity& D) {
    return integrate<Hex8>(corners_mm, D);
}
Wedge6Matrices wedge6_matrices(const Corners<6>& corners_mm, const Elasticity& D) {
    return integrate<Wedge6>(corners_mm, D);
}

double least_jacobian(const Corners<8>& corners_mm) {
    return least_determinant<Hex8>(corners_mm);
}
double least_jacobian(const Corners<6>& corners_mm) {
    return least_determinant<Wedge6>(corners_mm);
}

double principal_stress_sum(const Stress& s) {
    Eigen::Matrix3d tensor;
    tensor << s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2];
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;
    solver.computeDirect(tensor, Eigen::EigenvaluesOnly);
    return solver.eigenvalues().cwiseAbs().sum();
}

}  // namespace fretwork
