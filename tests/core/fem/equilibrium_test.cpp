#include <Eigen/Dense>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <vector>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/base/vec.h"
#include "core/fem/equilibrium_solver.h"
#include "core/fem/solid_elements.h"
#include "core/fem/stiffness_pattern.h"

namespace fretwork {
namespace {

/// nx x ny x nz hexahedra of a bar [0, length] x [0, width] x [0, height].
struct Bar {
    std::vector<Vec3> nodes_mm;
    ElementNodes elements;
    std::vector<Hex8Matrices> matrices;
    std::vector<std::uint8_t> fixed;

    Bar(const Vec3& size_mm, const std::array<int, 3>& cells, const Material& material) {
        const auto count = [&](int axis) { return static_cast<NodeIndex>(cells[static_cast<std::size_t>(axis)]) + 1; };
        for (NodeIndex k = 0; k < count(2); ++k)
            for (NodeIndex j = 0; j < count(1); ++j)
                for (NodeIndex i = 0; i < count(0); ++i)
                    nodes_mm.emplace_back(size_mm[0] * i / cells[0], size_mm[1] * j / cells[1],
                                          size_mm[2] * k / cells[2]);
        const auto index = [&](NodeIndex i, NodeIndex j, NodeIndex k) { return i + count(0) * (j + count(1) * k); };
        const Elasticity D = elasticity(material);
        for (NodeIndex k = 0; k + 1 < count(2); ++k)
            for (NodeIndex j = 0; j + 1 < count(1); ++j)
                for (NodeIndex i = 0; i + 1 < count(0); ++i) {
                    const std::array<NodeIndex, 8> nodes{
                        index(i, j, k),     index(i + 1, j, k),     index(i + 1, j + 1, k),     index(i, j + 1, k),
                        index(i, j, k + 1), index(i + 1, j, k + 1), index(i + 1, j + 1, k + 1), index(i, j + 1, k + 1)};
                    elements.add(nodes);
                    Corners<8> corners;
                    for (int n = 0; n < 8; ++n) corners.col(n) = nodes_mm[nodes[static_cast<std::size_t>(n)]];
                    matrices.push_back(hex8_matrices(corners, D));
                }
        fixed.assign(nodes_mm.size(), 0);
    }

    void hold(const std::function<bool(const Vec3&)>& where) {
        for (std::size_t n = 0; n < nodes_mm.size(); ++n)
            if (where(nodes_mm[n])) fixed[n] = 1;
    }

    std::vector<double> assembled(const StiffnessPattern& pattern) const {
        std::vector<double> values(pattern.entries(), 0.0);
        for (std::size_t e = 0; e < matrices.size(); ++e)
            pattern.add_element(e, 1.0, matrices[e].stiffness.data(), values);
        return values;
    }
};

Eigen::MatrixXd dense(const StiffnessPattern& pattern, const std::vector<double>& values) {
    const auto n = static_cast<Eigen::Index>(pattern.rows());
    Eigen::MatrixXd K = Eigen::MatrixXd::Zero(n, n);
    for (Eigen::Index column = 0; column < n; ++column) {
        const auto c = static_cast<std::size_t>(column);
        for (auto e = static_cast<std::size_t>(pattern.column_first()[c]);
             e < static_cast<std::size_t>(pattern.column_first()[c + 1]); ++e) {
            K(pattern.row()[e], column) = values[e];
            K(column, pattern.row()[e]) = values[e];
        }
    }
    return K;
}

/// Displacement per node; zero where fixed.
std::vector<Vec3> solve(const Bar& bar, const StiffnessPattern& pattern, const std::vector<Vec3>& loads_n) {
    Eigen::MatrixXd f = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pattern.rows()), 1);
    for (NodeIndex n = 0; n < bar.nodes_mm.size(); ++n)
        if (pattern.dof(n) != StiffnessPattern::kFixed) f.block<3, 1>(pattern.dof(n), 0) = loads_n[n];
    EquilibriumSolver solver(pattern);
    solver.factorize(bar.assembled(pattern));
    const Eigen::MatrixXd u = solver.solve(f);
    std::vector<Vec3> moved(bar.nodes_mm.size(), Vec3::Zero());
    for (NodeIndex n = 0; n < moved.size(); ++n)
        if (pattern.dof(n) != StiffnessPattern::kFixed) moved[n] = u.block<3, 1>(pattern.dof(n), 0);
    return moved;
}

const Material kAbs = material_by_name("ABS");

TEST_CASE("cantilever: bends like Timoshenko's beam", "[fem]") {
    // 40 x 5 x 5 mm, 1 N at the tip. The clamped end also hinders the section from contracting, which beam theory does
    // not know: an independent code with the same kind of element is 1.5 % stiffer on this grid of cubes, so 2 % are
    // allowed. With one element through the thickness the modes still bend; then 4 %.
    const double L = 40.0, a = 5.0, E = kAbs.youngs_modulus_mpa, nu = kAbs.poissons_ratio;
    const double I = a * a * a * a / 12.0, G = E / (2.0 * (1.0 + nu));
    const double expected = L * L * L / (3.0 * E * I) + L / (5.0 / 6.0 * G * a * a);
    for (const int through : {5, 1}) {
        Bar bar(Vec3(L, a, a), {40, through, through}, kAbs);
        bar.hold([](const Vec3& p) { return p[0] == 0.0; });
        const StiffnessPattern pattern(bar.elements, bar.fixed);
        std::vector<Vec3> loads(bar.nodes_mm.size(), Vec3::Zero());
        const double per_cell = 1.0 / (through * through);
        for (std::size_t n = 0; n < loads.size(); ++n) {
            if (bar.nodes_mm[n][0] != L) continue;
            // By tributary area: corners a quarter of a cell, edges a half.
            const bool edge_y = bar.nodes_mm[n][1] == 0.0 || bar.nodes_mm[n][1] == a;
            const bool edge_z = bar.nodes_mm[n][2] == 0.0 || bar.nodes_mm[n][2] == a;
            loads[n][2] = per_cell * (edge_y ? 0.5 : 1.0) * (edge_z ? 0.5 : 1.0);
        }
        const std::vector<Vec3> moved = solve(bar, pattern, loads);
        CHECK(moved.back()[2] == Approx(expected).epsilon(through == 5 ? 0.02 : 0.04));

        // Reactions: K u at the held nodes, with K of the whole bar.
        const StiffnessPattern whole(bar.elements, std::vector<std::uint8_t>(bar.nodes_mm.size(), 0));
        if (through > 1) continue;
        const Eigen::MatrixXd K = dense(whole, bar.assembled(whole));
        Eigen::VectorXd u(K.rows());
        for (std::size_t n = 0; n < moved.size(); ++n) u.segment<3>(static_cast<Eigen::Index>(3 * n)) = moved[n];
        const Eigen::VectorXd forces = K * u;
        Vec3 reaction = Vec3::Zero();
        double moment = 0.0;
        for (std::size_t n = 0; n < moved.size(); ++n)
            if (bar.fixed[n] != 0) {
                const Vec3 r = forces.segment<3>(static_cast<Eigen::Index>(3 * n));
                reaction += r;
                moment += bar.nodes_mm[n].cross(r)[1];
            }
        CHECK((reaction - Vec3(0, 0, -1)).norm() < 1e-7);
        // The load's moment about the root is -L N mm around y; the reactions hold against it.
        CHECK(moment == Approx(L).epsilon(1e-7));
    }
}

TEST_CASE("bar under its own weight: stress rho g (L - z) and displacement rho g (L z - z^2 / 2) / E", "[fem]") {
    // Poisson's ratio 0, so that the bar is one-dimensional and the held end hinders nothing.
    const Material material{"bar", 1000.0, 0.0, 2000.0, 1.0, 1.0};
    const double L = 30.0, a = 3.0;
    const int cells = 15;
    Bar bar(Vec3(a, a, L), {2, 2, cells}, material);
    bar.hold([](const Vec3& p) { return p[2] == 0.0; });
    const double rho_g = material.density_kg_m3 * 9.81e-9;  // N/mm^3
    std::vector<Vec3> loads(bar.nodes_mm.size(), Vec3::Zero());
    for (std::size_t e = 0; e < bar.elements.size(); ++e)
        for (const NodeIndex n : bar.elements.of(e)) loads[n][2] -= rho_g * bar.matrices[e].volume_mm3 / 8.0;
    const StiffnessPattern pattern(bar.elements, bar.fixed);
    const std::vector<Vec3> moved = solve(bar, pattern, loads);
    for (std::size_t n = 0; n < moved.size(); ++n) {
        const double z = bar.nodes_mm[n][2];
        CHECK(moved[n][2] == Approx(-rho_g / 1000.0 * (L * z - 0.5 * z * z)).margin(1e-15));
    }
    for (std::size_t e = 0; e < bar.elements.size(); ++e) {
        Eigen::Matrix<double, 24, 1> u;
        double z = 0.0;
        for (int n = 0; n < 8; ++n) {
            const NodeIndex node = bar.elements.of(e)[static_cast<std::size_t>(n)];
            u.segment<3>(3 * n) = moved[node];
            z += bar.nodes_mm[node][2] / 8.0;
        }
        Stress mean = Stress::Zero();
        for (const auto& stress_operator : bar.matrices[e].stress_operator) mean += stress_operator * u / 8.0;
        CHECK(mean[2] == Approx(-rho_g * (L - z)).epsilon(1e-9));
    }
}

TEST_CASE("equilibrium solver: agrees with a dense solution, again after new values", "[fem]") {
    Bar bar(Vec3(4, 3, 3), {4, 3, 2}, kAbs);
    bar.hold([](const Vec3& p) { return p[0] == 0.0 && p[1] < 1.5; });
    const StiffnessPattern pattern(bar.elements, bar.fixed);
    EquilibriumSolver solver(pattern);
    std::vector<double> values = bar.assembled(pattern);
    const Eigen::MatrixXd f = Eigen::MatrixXd::NullaryExpr(
        static_cast<Eigen::Index>(pattern.rows()), 5,
        [](Eigen::Index i, Eigen::Index j) { return std::sin(static_cast<double>(3 * i + 7 * j + 1)); });
    for (int round = 0; round < 3; ++round) {
        const Eigen::MatrixXd K = dense(pattern, values);
        CHECK((K - K.transpose()).norm() == 0.0);
        solver.factorize(values);
        const Eigen::MatrixXd expected = K.ldlt().solve(f);
        CHECK((solver.solve(f) - expected).norm() < 1e-9 * expected.norm());
        pattern.add_element(static_cast<std::size_t>(round), 5.0, bar.matrices[0].stiffness.data(), values);
    }
}

TEST_CASE("stiffness pattern: sums of elements, without rows of fixed nodes", "[fem][property]") {
    Bar bar(Vec3(2, 2, 3), {2, 2, 3}, kAbs);
    bar.hold([](const Vec3& p) { return p[2] == 1.0 && p[0] > 0.5; });
    const StiffnessPattern pattern(bar.elements, bar.fixed);
    const Eigen::MatrixXd K = dense(pattern, bar.assembled(pattern));
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(K.rows(), K.cols());
    for (std::size_t e = 0; e < bar.elements.size(); ++e) {
        const auto nodes = bar.elements.of(e);
        for (std::size_t p = 0; p < 8; ++p)
            for (std::size_t q = 0; q < 8; ++q) {
                if (pattern.dof(nodes[p]) == StiffnessPattern::kFixed) continue;
                if (pattern.dof(nodes[q]) == StiffnessPattern::kFixed) continue;
                expected.block<3, 3>(pattern.dof(nodes[p]), pattern.dof(nodes[q])) +=
                    bar.matrices[e].stiffness.block<3, 3>(static_cast<Eigen::Index>(3 * p),
                                                          static_cast<Eigen::Index>(3 * q));
            }
    }
    CHECK((K - expected).norm() < 1e-12 * expected.norm());
    std::size_t fixed = 0;
    for (const std::uint8_t f : bar.fixed) fixed += f;
    REQUIRE(fixed > 0);
    CHECK(pattern.free_nodes() + fixed == bar.nodes_mm.size());
}

TEST_CASE("equilibrium solver: the same bits on any number of threads", "[fem][determinism]") {
    Bar bar(Vec3(12, 12, 12), {10, 10, 10}, kAbs);
    bar.hold([](const Vec3& p) { return p[2] == 0.0; });
    const StiffnessPattern pattern(bar.elements, bar.fixed);
    std::vector<Vec3> loads(bar.nodes_mm.size(), Vec3(0.1, 0.2, -1.0));
    const std::vector<Vec3> reference = solve(bar, pattern, loads);
    for (const int threads : {1, 2, 4}) {
        const ThreadLimit limit(threads);
        CHECK(solve(bar, pattern, loads) == reference);
    }
}

TEST_CASE("equilibrium solver: says when something moves freely", "[fem]") {
    const Bar bar(Vec3(2, 1, 1), {2, 1, 1}, kAbs);
    const StiffnessPattern pattern(bar.elements, bar.fixed);
    EquilibriumSolver solver(pattern);
    CHECK_THROWS_AS(solver.solve(Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(pattern.rows()), 1)), SolverFailure);
    std::vector<double> values = bar.assembled(pattern);
    values[0] = -1.0;
    CHECK_THROWS_AS(solver.factorize(values), SolverFailure);
    CHECK_THROWS_AS(solver.factorize(std::vector<double>(pattern.entries(), 0.0)), SolverFailure);
}

TEST_CASE("equilibrium solver: nothing free is nothing to do", "[fem]") {
    Bar bar(Vec3(1, 1, 1), {1, 1, 1}, kAbs);
    bar.hold([](const Vec3&) { return true; });
    const StiffnessPattern pattern(bar.elements, bar.fixed);
    EquilibriumSolver solver(pattern);
    solver.factorize({});
    CHECK(solver.solve(Eigen::MatrixXd(0, 3)).cols() == 3);
}

TEST_CASE("materials: known by name in any case, unknown ones named", "[fem]") {
    CHECK(known_materials().size() == 5);
    for (const Material& material : known_materials()) {
        CHECK(material_by_name(material.name).youngs_modulus_mpa == material.youngs_modulus_mpa);
        CHECK(material.strength_z_mpa <= material.strength_xy_mpa);
        CHECK_NOTHROW(elasticity(material));
    }
    CHECK(material_by_name("pLa").density_kg_m3 == 1240.0);
    CHECK_THROWS_WITH(material_by_name("steel"), Catch::Contains("steel") && Catch::Contains("PETG"));
    CHECK_THROWS_AS(material_by_name(""), InvalidSetting);
}

}  // namespace
}  // namespace fretwork
