// Stage 5e: linear programs that differ in what they aim at alone.
#pragma once

#include <Eigen/Core>
#include <memory>

namespace fretwork {

/// max c'x over x >= 0, A x = b, for many c on the same A and b. GLPK's simplex method underneath; a solution has at
/// most as many entries above zero as A has rows. Belongs to one thread.
class LinearProgram {
  public:
    /// Looks for a first solution. \param A  rows of like size, columns too; rows may depend on each other
    /// \throws SolverFailure  an entry is not finite.
    LinearProgram(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
    ~LinearProgram();
    LinearProgram(LinearProgram&&) noexcept;
    LinearProgram& operator=(LinearProgram&&) noexcept;

    /// Is there an x >= 0 with A x = b?
    [[nodiscard]] bool feasible() const;

    /// Starts from the solution before. Cost: some ten steps of rows x columns each.
    /// \throws SolverFailure  not feasible, c'x has no upper bound, or an entry is not finite.
    Eigen::VectorXd maximize(const Eigen::VectorXd& c);

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace fretwork
