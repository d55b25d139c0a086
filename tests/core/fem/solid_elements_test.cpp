#include "core/fem/solid_elements.h"

#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "core/base/error.h"
#include "core/fem/frame_link.h"

namespace fretwork {
namespace {

const Material kTestMaterial{"test", 2000.0, 0.35, 1040.0, 34.0, 20.0};

Corners<8> unit_hexahedron() {
    Corners<8> c;
    c << 0, 1, 1, 0, 0, 1, 1, 0,  //
        0, 0, 1, 1, 0, 0, 1, 1,   //
        0, 0, 0, 0, 1, 1, 1, 1;
    return c;
}

Corners<6> unit_wedge() {
    Corners<6> c;
    c << 0, 1, 0, 0, 1, 0,  //
        0, 0, 1, 0, 0, 1,   //
        0, 0, 0, 1, 1, 1;
    return c;
}

template <int N>
Corners<N> distorted(Corners<N> c, unsigned seed, double by) {
    std::mt19937 rng{seed};
    std::uniform_real_distribution<double> shift(-by, by);
    for (int n = 0; n < N; ++n)
        for (int axis = 0; axis < 3; ++axis) c(axis, n) += shift(rng);
    Eigen::Matrix3d map = 2.0 * Eigen::Matrix3d::Identity();
    map(0, 1) = 0.7;
    map(2, 0) = -0.4;
    return map * c;
}

/// Displacements of the corners in the field u(x) = A x + b.
template <int N>
Eigen::Matrix<double, 3 * N, 1> linear_field(const Corners<N>& c, const Eigen::Matrix3d& A, const Vec3& b) {
    Eigen::Matrix<double, 3 * N, 1> u;
    for (int n = 0; n < N; ++n) u.template segment<3>(3 * n) = A * c.col(n) + b;
    return u;
}

Stress stress_of(const Eigen::Matrix3d& A, const Elasticity& D) {
    Stress strain;
    strain << A(0, 0), A(1, 1), A(2, 2), A(0, 1) + A(1, 0), A(1, 2) + A(2, 1), A(0, 2) + A(2, 0);
    return D * strain;
}

Eigen::Matrix3d some_gradient() {
    Eigen::Matrix3d A;
    A << 1.0e-3, 2.0e-3, -1.5e-3, 0.5e-3, -2.0e-3, 1.0e-3, 3.0e-3, -1.0e-3, 0.7e-3;
    return A;
}

template <int N, int P>
void check_element(const ElementMatrices<N, P>& element, const Corners<N>& corners, const Elasticity& D) {
    const double scale = element.stiffness.norm();
    CHECK((element.stiffness - element.stiffness.transpose()).norm() == 0.0);

    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(element.stiffness);
    int zero = 0;
    for (int i = 0; i < 3 * N; ++i) {
        CHECK(solver.eigenvalues()[i] > -1e-10 * scale);
        zero += solver.eigenvalues()[i] < 1e-8 * scale ? 1 : 0;
    }
    CHECK(zero == 6);

    // A linear field has one stress everywhere, and an energy of volume / 2 times strain times stress.
    const Eigen::Matrix3d A = some_gradient();
    const auto u = linear_field<N>(corners, A, Vec3(0.1, -0.2, 0.3));
    const Stress expected = stress_of(A, D);
    for (const auto& stress_operator : element.stress_operator)
        CHECK((stress_operator * u - expected).norm() < 1e-10 * expected.norm());
    Stress strain;
    strain << A(0, 0), A(1, 1), A(2, 2), A(0, 1) + A(1, 0), A(1, 2) + A(2, 1), A(0, 2) + A(2, 0);
    CHECK(u.dot(element.stiffness * u) == Approx(element.volume_mm3 * strain.dot(expected)).epsilon(1e-10));
}

TEST_CASE("hexahedron: symmetric, six rigid motions, constant strain on any shape", "[fem][property]") {
    const auto seed = GENERATE(range(1u, 9u));
    CAPTURE(seed);
    const Elasticity D = elasticity(kTestMaterial);
    const Corners<8> corners = distorted(unit_hexahedron(), seed, 0.15);
    REQUIRE(least_jacobian(corners) > 0.0);
    check_element(hex8_matrices(corners, D), corners, D);
}

TEST_CASE("wedge: symmetric, six rigid motions, constant strain on any shape", "[fem][property]") {
    const auto seed = GENERATE(range(1u, 9u));
    CAPTURE(seed);
    const Elasticity D = elasticity(kTestMaterial);
    const Corners<6> corners = distorted(unit_wedge(), seed, 0.12);
    REQUIRE(least_jacobian(corners) > 0.0);
    check_element(wedge6_matrices(corners, D), corners, D);
}

TEST_CASE("elements: volumes are those of the solids", "[fem]") {
    const Elasticity D = elasticity(kTestMaterial);
    Eigen::Matrix3d map;
    map << 2, 0.5, 0, 0, 3, 0.2, 0.1, 0, 4;
    const double scale = map.determinant();
    CHECK(hex8_matrices(map * unit_hexahedron(), D).volume_mm3 == Approx(scale).epsilon(1e-12));
    CHECK(wedge6_matrices(map * unit_wedge(), D).volume_mm3 == Approx(0.5 * scale).epsilon(1e-12));
}

/// Two elements' worth of a patch test: a ring of distorted elements around one free node.
template <int N>
struct Patch {
    std::vector<Vec3> nodes;
    std::vector<std::array<std::size_t, N>> elements;
    std::vector<std::size_t> inner;
};

/// 2 x 2 x 2 hexahedra with every inner node (one) and the face centres moved.
Patch<8> hexahedra_patch(unsigned seed) {
    std::mt19937 rng{seed};
    std::uniform_real_distribution<double> shift(-0.2, 0.2);
    Patch<8> patch;
    const auto index = [](std::size_t i, std::size_t j, std::size_t k) { return i + 3 * (j + 3 * k); };
    for (int k = 0; k < 3; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) patch.nodes.emplace_back(i + shift(rng), j + shift(rng), k + shift(rng));
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t j = 0; j < 2; ++j)
            for (std::size_t i = 0; i < 2; ++i)
                patch.elements.push_back({index(i, j, k), index(i + 1, j, k), index(i + 1, j + 1, k),
                                          index(i, j + 1, k), index(i, j, k + 1), index(i + 1, j, k + 1),
                                          index(i + 1, j + 1, k + 1), index(i, j + 1, k + 1)});
    patch.inner = {index(1, 1, 1)};
    return patch;
}

/// Six wedges around a column of three nodes, in two layers; the middle node is free.
Patch<6> wedges_patch(unsigned seed) {
    std::mt19937 rng{seed};
    std::uniform_real_distribution<double> shift(-0.15, 0.15);
    Patch<6> patch;
    const std::size_t per_layer = 7;
    for (int k = 0; k < 3; ++k) {
        patch.nodes.emplace_back(shift(rng), shift(rng), k + shift(rng));
        for (int i = 0; i < 6; ++i)
            patch.nodes.emplace_back(std::cos(i * M_PI / 3) + shift(rng), std::sin(i * M_PI / 3) + shift(rng),
                                     k + shift(rng));
    }
    for (std::size_t k = 0; k < 2; ++k)
        for (std::size_t i = 0; i < 6; ++i) {
            const std::size_t low = k * per_layer, high = low + per_layer;
            const std::size_t next = (i + 1) % 6;
            patch.elements.push_back({low, low + 1 + i, low + 1 + next, high, high + 1 + i, high + 1 + next});
        }
    patch.inner = {per_layer};
    return patch;
}

Hex8Matrices matrices(const Corners<8>& c, const Elasticity& D) {
    return hex8_matrices(c, D);
}
Wedge6Matrices matrices(const Corners<6>& c, const Elasticity& D) {
    return wedge6_matrices(c, D);
}

/// Outer nodes follow a linear field; the inner ones must find it by themselves.
template <int N>
void check_patch(const Patch<N>& patch) {
    const Elasticity D = elasticity(kTestMaterial);
    const auto dofs = static_cast<Eigen::Index>(3 * patch.nodes.size());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(dofs, dofs);
    for (const auto& element : patch.elements) {
        Corners<N> corners;
        for (int n = 0; n < N; ++n) corners.col(n) = patch.nodes[element[static_cast<std::size_t>(n)]];
        const auto Ke = matrices(corners, D).stiffness;
        for (int p = 0; p < N; ++p)
            for (int q = 0; q < N; ++q)
                K.block<3, 3>(static_cast<Eigen::Index>(3 * element[static_cast<std::size_t>(p)]),
                              static_cast<Eigen::Index>(3 * element[static_cast<std::size_t>(q)])) +=
                    Ke.template block<3, 3>(3 * p, 3 * q);
    }
    Eigen::VectorXd u(dofs);
    for (std::size_t n = 0; n < patch.nodes.size(); ++n)
        u.segment<3>(static_cast<Eigen::Index>(3 * n)) = some_gradient() * patch.nodes[n] + Vec3(0.1, 0.2, 0.3);
    for (const std::size_t n : patch.inner) {
        const auto at = static_cast<Eigen::Index>(3 * n);
        const Vec3 expected = u.segment<3>(at);
        u.segment<3>(at).setZero();
        const Vec3 load = -(K * u).segment<3>(at);
        const Vec3 found = K.block<3, 3>(at, at).ldlt().solve(load);
        CHECK((found - expected).norm() < 1e-10 * expected.norm());
    }
}

TEST_CASE("patch test: free nodes among distorted elements find a linear field", "[fem][property]") {
    const auto seed = GENERATE(range(1u, 7u));
    CAPTURE(seed);
    check_patch(hexahedra_patch(seed));
    check_patch(wedges_patch(seed));
}

TEST_CASE("elements: fold when a corner passes through", "[fem]") {
    const Elasticity D = elasticity(kTestMaterial);
    Corners<8> hexahedron = unit_hexahedron();
    hexahedron.col(6) = Vec3(-0.5, -0.5, -0.5);
    CHECK(least_jacobian(hexahedron) < 0.0);
    CHECK_THROWS_AS(hex8_matrices(hexahedron, D), InvalidInput);
    Corners<6> wedge = unit_wedge();
    wedge.col(1).swap(wedge.col(2));
    wedge.col(4).swap(wedge.col(5));
    CHECK(least_jacobian(wedge) < 0.0);
    CHECK_THROWS_AS(wedge6_matrices(wedge, D), InvalidInput);
    CHECK(least_jacobian(unit_hexahedron()) == Approx(0.125));
    CHECK(least_jacobian(unit_wedge()) == Approx(0.5));
}

TEST_CASE("elasticity: uniaxial stress gives E and Poisson's ratio back", "[fem]") {
    const Elasticity D = elasticity(kTestMaterial);
    Stress pull = Stress::Zero();
    pull[0] = 1.0;
    const Stress strain = D.inverse() * pull;
    CHECK(strain[0] == Approx(1.0 / 2000.0));
    CHECK(strain[1] == Approx(-0.35 / 2000.0));
    CHECK(strain[2] == Approx(-0.35 / 2000.0));
    Material bad = kTestMaterial;
    bad.poissons_ratio = 0.5;
    CHECK_THROWS_AS(elasticity(bad), InvalidSetting);
    bad = kTestMaterial;
    bad.youngs_modulus_mpa = 0.0;
    CHECK_THROWS_AS(elasticity(bad), InvalidSetting);
    bad = kTestMaterial;
    bad.density_kg_m3 = -1.0;
    CHECK_THROWS_AS(elasticity(bad), InvalidSetting);
}

TEST_CASE("principal_stress_sum: does not change when the axes turn", "[fem][property]") {
    const auto seed = GENERATE(range(1u, 9u));
    std::mt19937 rng{seed};
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    const Vec3 principal(any(rng), any(rng), any(rng));
    const Eigen::Matrix3d R =
        Eigen::Quaterniond(any(rng), any(rng), any(rng), any(rng)).normalized().toRotationMatrix();
    const Eigen::Matrix3d S = R * principal.asDiagonal() * R.transpose();
    Stress stress;
    stress << S(0, 0), S(1, 1), S(2, 2), S(0, 1), S(1, 2), S(0, 2);
    CHECK(principal_stress_sum(stress) == Approx(principal.cwiseAbs().sum()).epsilon(1e-6));
}

/// Rigid motion of corners: translation and rotation about the origin.
Eigen::Matrix<double, 24, 1> rigid(const Corners<8>& c, const Vec3& shift, const Vec3& turn) {
    Eigen::Matrix<double, 24, 1> u;
    for (int n = 0; n < 8; ++n) u.segment<3>(3 * n) = shift + turn.cross(Vec3(c.col(n)));
    return u;
}

TEST_CASE("frame link: rigid motions cost nothing, whatever the corners", "[fem][property]") {
    const auto seed = GENERATE(range(1u, 7u));
    CAPTURE(seed);
    // Far beyond what a hexahedron can be.
    const Corners<8> corners = distorted(unit_hexahedron(), seed, 0.9);
    const FrameLinkMatrices link = frame_link_matrices(corners, Vec3::UnitZ(), {1.0, 2.0}, kTestMaterial);
    const double scale = link.stiffness.norm();
    for (int i = 0; i < 3; ++i) {
        CHECK((link.stiffness * rigid(corners, Vec3::Unit(i), Vec3::Zero())).norm() < 1e-9 * scale);
        CHECK((link.stiffness * rigid(corners, Vec3::Zero(), Vec3::Unit(i))).norm() < 1e-9 * scale);
    }
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(link.stiffness);
    CHECK(solver.eigenvalues()[0] > -1e-9 * scale);
    int stiff = 0;
    for (int i = 0; i < 24; ++i) stiff += solver.eigenvalues()[i] > 1e-9 * scale ? 1 : 0;
    CHECK(stiff == 6);
}

TEST_CASE("frame link: pulled and bent like a beam", "[fem]") {
    // A bar 10 long, 1 wide, 2 thick, its left end held.
    const double L = 10.0, w = 1.0, t = 2.0, E = 2000.0, nu = 0.35;
    Corners<8> corners = unit_hexahedron();
    corners.row(0) *= L;
    corners.row(1) *= w;
    corners.row(2) *= t;
    const BeamSection section{w, t};
    const FrameLinkMatrices link = frame_link_matrices(corners, Vec3::UnitZ(), section, kTestMaterial);

    Eigen::Matrix<double, 24, 1> pull = Eigen::Matrix<double, 24, 1>::Zero();
    for (const int n : {1, 2, 6, 5}) pull[3 * n] = 0.01;
    const Eigen::Matrix<double, 6, 1> forces = link.end_forces[1] * pull;
    CHECK(forces[0] == Approx(E * w * t * 0.01 / L));
    CHECK(frame_link_stress_sum(forces, section) == Approx(E * 0.01 / L));

    // A tip force across the wall, the tip free to turn: solve for the six motions of the tip's section.
    Eigen::Matrix<double, 24, 6> tip;
    for (int i = 0; i < 3; ++i) {
        for (int n = 0; n < 8; ++n) {
            const bool right = n == 1 || n == 2 || n == 5 || n == 6;
            const Vec3 arm = Vec3(corners.col(n)) - Vec3(L, 0.5 * w, 0.5 * t);
            tip.block<3, 1>(3 * n, i) = right ? Vec3(Vec3::Unit(i)) : Vec3(Vec3::Zero());
            tip.block<3, 1>(3 * n, i + 3) = right ? Vec3(Vec3::Unit(i).cross(arm)) : Vec3(Vec3::Zero());
        }
    }
    const Eigen::Matrix<double, 6, 6> K = tip.transpose() * link.stiffness * tip;
    const double P = 3.0;
    Eigen::Matrix<double, 6, 1> load = Eigen::Matrix<double, 6, 1>::Zero();
    load[2] = P;
    const Eigen::Matrix<double, 6, 1> moved = K.ldlt().solve(load);
    const double I = w * t * t * t / 12.0, G = E / (2.0 * (1.0 + nu));
    CHECK(moved[2] == Approx(P * L * L * L / (3.0 * E * I) + P * L / (5.0 / 6.0 * G * w * t)).epsilon(1e-9));
    CHECK(std::abs(moved[4]) == Approx(P * L * L / (2.0 * E * I)).epsilon(1e-9));
    // At the root the largest stress is that of the bending moment P L, with the mean shear.
    const Eigen::Matrix<double, 6, 1> root = link.end_forces[0] * (tip * moved);
    const double bending = P * L * (0.5 * t) / I, shear = P / (w * t);
    CHECK(frame_link_stress_sum(root, section) ==
          Approx(std::sqrt(bending * bending + 4 * shear * shear)).epsilon(1e-6));
}

}  // namespace
}  // namespace fretwork
