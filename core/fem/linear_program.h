// Stage 5e: linear programs of few rows and many columns.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace fretwork {

/// max c'x over x >= 0, A x = b, for many c on the same A and b. The revised simplex method with Bland's rule against
/// cycles; the basis, as large as A has rows, is factored anew in every step, so that errors do not add up. A solution
/// has at most as many entries above zero as A has rows.
class LinearProgram {
  public:
    /// Looks for a first solution. \param A  rows of like size, columns too; rows may depend on each other
    LinearProgram(Eigen::MatrixXd A, Eigen::VectorXd b);

    /// Is there an x >= 0 with A x = b?
    [[nodiscard]] bool feasible() const { return feasible_; }

    /// Starts from the solution before. Cost: some ten steps of rows x columns each.
    /// \throws SolverFailure  not feasible, or c'x has no upper bound.
    Eigen::VectorXd maximize(const Eigen::VectorXd& c);

  private:
    [[nodiscard]] Eigen::VectorXd column(Eigen::Index j) const;
    [[nodiscard]] Eigen::Index entering(const Eigen::VectorXd& cost, const Eigen::VectorXd& prices, bool first) const;
    [[nodiscard]] Eigen::Index leaving(const Eigen::VectorXd& step, bool first_phase) const;
    void improve(const Eigen::VectorXd& cost, double artificial_cost);

    Eigen::MatrixXd rows_;
    Eigen::VectorXd b_;
    std::vector<Eigen::Index> basis_;  ///< columns of A; A's columns + i for the artificial one of row i
    Eigen::VectorXd value_;            ///< of the basis
    bool feasible_ = false;
};

}  // namespace fretwork
