// Stage 10b: a system with a factored matrix: the coarse level, or a small model as a whole. Internal to this folder
// and its tests.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/run_control.h"
#include "core/fem/equilibrium_solver.h"
#include "core/fem/stiffness_pattern.h"

namespace fretwork {

/// Pattern, matrix and factor, built and solved on a thread that can be left behind.
class FactoredSystem {
  public:
    /// Elements with their matrices, 24 x 24, column after column.
    struct Elements {
        ElementNodes nodes;
        std::vector<std::uint8_t> fixed;                   ///< per node
        std::vector<Eigen::Matrix<double, 24, 24>> kinds;  ///< the different matrices
        std::vector<std::uint32_t> kind;                   ///< per element
        double diagonal_factor = 1.0;                      ///< slightly above 1 where columns may repeat
    };

    /// \param most_bytes  that the factor may take
    /// \throws MemoryLimit    it would take more
    /// \throws SolverFailure  something moves freely
    /// \throws Cancelled      within 50 ms of a stop request, whatever is under way
    FactoredSystem(Elements elements, std::size_t most_bytes, const RunControl& run);

    /// First of the three rows of a node, or StiffnessPattern::kFixed.
    [[nodiscard]] std::int64_t row(std::size_t node) const { return rows_[node]; }
    [[nodiscard]] std::int64_t rows() const { return row_count_; }
    [[nodiscard]] std::size_t factor_bytes() const { return factor_bytes_; }

    [[nodiscard]] Eigen::MatrixXd solve(Eigen::MatrixXd loads, const RunControl& run) const;

  private:
    struct Factored;
    std::shared_ptr<Factored> factored_;
    std::vector<std::int64_t> rows_;
    std::int64_t row_count_ = 0;
    std::size_t factor_bytes_ = 0;
};

}  // namespace fretwork
