#include "core/fem/linear_program.h"

#include <Eigen/LU>
#include <limits>
#include <utility>

#include "core/base/error.h"

namespace fretwork {
namespace {

constexpr double kZero = 1e-10;     // against entries of about one
constexpr double kFeasible = 1e-7;  // sum of artificial columns that is none
constexpr int kStepsBeforeBland = 200;
constexpr int kMostSteps = 20000;

}  // namespace

LinearProgram::LinearProgram(Eigen::MatrixXd A, Eigen::VectorXd b) : rows_(std::move(A)), b_(std::move(b)) {
    for (Eigen::Index i = 0; i < b_.size(); ++i) {
        if (b_[i] < 0.0) {
            rows_.row(i) *= -1.0;
            b_[i] *= -1.0;
        }
        basis_.push_back(rows_.cols() + i);
    }
    value_ = b_;
    improve(Eigen::VectorXd::Zero(rows_.cols()), -1.0);
    double artificial = 0.0;
    for (Eigen::Index i = 0; i < b_.size(); ++i)
        if (basis_[static_cast<std::size_t>(i)] >= rows_.cols()) artificial += value_[i];
    feasible_ = artificial <= kFeasible * (1.0 + b_.sum());
}

Eigen::VectorXd LinearProgram::maximize(const Eigen::VectorXd& c) {
    if (!feasible_) throw SolverFailure("linear program: no solution meets its equations");
    const double size = c.cwiseAbs().maxCoeff();
    if (size > 0.0) improve(c / size, 0.0);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(rows_.cols());
    for (std::size_t i = 0; i < basis_.size(); ++i)
        if (basis_[i] < rows_.cols()) x[basis_[i]] = std::max(0.0, value_[static_cast<Eigen::Index>(i)]);
    return x;
}

Eigen::VectorXd LinearProgram::column(Eigen::Index j) const {
    return j < rows_.cols() ? Eigen::VectorXd(rows_.col(j))
                            : Eigen::VectorXd(Eigen::VectorXd::Unit(b_.size(), j - rows_.cols()));
}

/// The column that gains most per unit, or the first that gains; -1 where none does. Artificial ones stay out.
Eigen::Index LinearProgram::entering(const Eigen::VectorXd& cost, const Eigen::VectorXd& prices, bool first) const {
    const Eigen::VectorXd gain = cost - rows_.transpose() * prices;
    Eigen::Index best = -1;
    for (Eigen::Index j = 0; j < gain.size(); ++j) {
        if (gain[j] <= kZero || (best >= 0 && gain[j] <= gain[best])) continue;
        best = j;
        if (first) break;
    }
    return best;
}

/// The row whose value reaches zero first; -1 where none does. An artificial column that is still there once a
/// solution is known leaves as soon as it would change.
Eigen::Index LinearProgram::leaving(const Eigen::VectorXd& step, bool first_phase) const {
    Eigen::Index best = -1;
    double least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < step.size(); ++i) {
        const bool stuck = !first_phase && basis_[static_cast<std::size_t>(i)] >= rows_.cols();
        if (stuck && std::abs(step[i]) > kFeasible) return i;
        if (stuck || step[i] <= kZero) continue;
        const double ratio = std::max(0.0, value_[i]) / step[i];
        const bool tie = best >= 0 && ratio == least;
        if (ratio < least || (tie && basis_[static_cast<std::size_t>(i)] < basis_[static_cast<std::size_t>(best)])) {
            best = i;
            least = ratio;
        }
    }
    return best;
}

void LinearProgram::improve(const Eigen::VectorXd& cost, double artificial_cost) {
    const Eigen::Index rows = b_.size();
    for (int steps = 0; steps < kMostSteps; ++steps) {
        Eigen::MatrixXd basis(rows, rows);
        Eigen::VectorXd basis_cost(rows);
        for (Eigen::Index i = 0; i < rows; ++i) {
            const Eigen::Index j = basis_[static_cast<std::size_t>(i)];
            basis.col(i) = column(j);
            basis_cost[i] = j < rows_.cols() ? cost[j] : artificial_cost;
        }
        const Eigen::PartialPivLU<Eigen::MatrixXd> lu(basis);
        value_ = lu.solve(b_);
        const Eigen::Index enters = entering(cost, lu.transpose().solve(basis_cost), steps > kStepsBeforeBland);
        if (enters < 0) return;
        const Eigen::Index leaves = leaving(lu.solve(rows_.col(enters)), artificial_cost != 0.0);
        if (leaves < 0) throw SolverFailure("linear program: the aim has no upper bound");
        basis_[static_cast<std::size_t>(leaves)] = enters;
    }
    throw SolverFailure("linear program: no end after " + std::to_string(kMostSteps) + " steps");
}

}  // namespace fretwork
