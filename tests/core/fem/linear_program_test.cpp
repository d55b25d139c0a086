#include "core/fem/linear_program.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>
#include <limits>

#include "core/base/counter_random.h"
#include "core/base/error.h"

namespace fretwork {
namespace {

Eigen::MatrixXd random_matrix(Eigen::Index rows, Eigen::Index columns, std::uint64_t seed) {
    Eigen::MatrixXd result(rows, columns);
    for (Eigen::Index i = 0; i < rows; ++i)
        for (Eigen::Index j = 0; j < columns; ++j)
            result(i, j) = 2.0 * unit_interval(counter_random(seed, RandomStream::kTest, static_cast<std::uint32_t>(i),
                                                              static_cast<std::uint64_t>(j), 0)) -
                           1.0;
    return result;
}

/// Over all choices of three columns of A; -infinity where none gives a solution.
double best_vertex(const Eigen::MatrixXd& A, const Eigen::Vector3d& b, const Eigen::VectorXd& c) {
    double best = -std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < A.cols(); ++i)
        for (Eigen::Index j = 0; j < i; ++j)
            for (Eigen::Index k = 0; k < j; ++k) {
                Eigen::Matrix3d basis;
                basis << A.col(i), A.col(j), A.col(k);
                const Eigen::Vector3d x = basis.fullPivLu().solve(b);
                if (x.minCoeff() < -1e-9 || (basis * x - b).norm() > 1e-9) continue;
                best = std::max(best, c[i] * x[0] + c[j] * x[1] + c[k] * x[2]);
            }
    return best;
}

TEST_CASE("linear program: as good as the best of all vertices", "[fem][property]") {
    int with_solution = 0;
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
        CAPTURE(seed);
        Eigen::MatrixXd A = random_matrix(3, 12, seed);
        A.row(2).setOnes();  // so that nothing grows without end
        const Eigen::Vector3d b(seed % 3 == 0 ? 0.4 : 0.0, seed % 2 == 0 ? -0.3 : 0.0, 1.0);
        const Eigen::VectorXd c = random_matrix(12, 3, seed + 100).col(0);
        LinearProgram program(A, b);
        const double best = best_vertex(A, b, c);
        REQUIRE(program.feasible() == std::isfinite(best));
        if (!program.feasible()) {
            CHECK_THROWS_AS(program.maximize(c), SolverFailure);
            continue;
        }
        ++with_solution;
        for (const double sign : {1.0, -1.0, 1.0}) {
            const Eigen::VectorXd x = program.maximize(sign * c);
            CHECK(x.minCoeff() >= 0.0);
            CHECK((A * x - b).norm() < 1e-9);
            CHECK(c.dot(x) == Approx(sign * best_vertex(A, b, sign * c)).margin(1e-9));
        }
    }
    CHECK(with_solution > 30);
    CHECK(with_solution < 60);
}

TEST_CASE("linear program: rows may say the same twice, and contradictions are found", "[fem]") {
    Eigen::MatrixXd A(3, 4);
    A << 1, 1, 1, 1, 2, 2, 2, 2, 1, -1, 0, 0;
    const Eigen::Vector4d c(0, 1, 3, 2);
    LinearProgram twice(A, Eigen::Vector3d(1, 2, 0));
    REQUIRE(twice.feasible());
    CHECK((twice.maximize(c) - Eigen::Vector4d(0, 0, 1, 0)).norm() < 1e-12);
    CHECK((twice.maximize(Eigen::Vector4d(1, 4, 2, 0)) - Eigen::Vector4d(0.5, 0.5, 0, 0)).norm() < 1e-12);
    CHECK_FALSE(LinearProgram(A, Eigen::Vector3d(1, 3, 0)).feasible());
    LinearProgram open(A.row(2), Eigen::VectorXd::Zero(1));
    CHECK_THROWS_AS(open.maximize(c), SolverFailure);
}

}  // namespace
}  // namespace fretwork
