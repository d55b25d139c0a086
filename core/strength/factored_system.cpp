#include "core/strength/factored_system.h"

#include <fmt/format.h>

#include <utility>

#include "core/base/detached.h"
#include "core/base/error.h"

namespace fretwork {

/// The solver refers to the pattern: both live and die together, also when nobody waits any more.
struct FactoredSystem::Factored {
    StiffnessPattern pattern;
    EquilibriumSolver solver;

    explicit Factored(const Elements& elements) : pattern(elements.nodes, elements.fixed), solver(pattern) {}

    void factorize(const Elements& elements) {
        std::vector<double> values(pattern.entries(), 0.0);
        for (std::size_t e = 0; e < elements.kind.size(); ++e)
            pattern.add_element(e, 1.0, elements.kinds[elements.kind[e]].data(), values);
        // The diagonal comes first in each column of the lower triangle.
        for (std::size_t column = 0; column < pattern.rows(); ++column)
            values[static_cast<std::size_t>(pattern.column_first()[column])] *= elements.diagonal_factor;
        solver.factorize(values);
    }
};

FactoredSystem::FactoredSystem(Elements elements, std::size_t most_bytes, const RunControl& run) {
    const auto shared = std::make_shared<const Elements>(std::move(elements));
    factored_ = run_detached([shared] { return std::make_shared<Factored>(*shared); }, run);
    factor_bytes_ = factored_->solver.factor_bytes();
    if (factor_bytes_ > most_bytes)
        throw MemoryLimit(
            fmt::format("strength: the factor of {} equations takes {:.1f} GB, allowed are {:.1f} GB; "
                        "larger voxels need less",
                        factored_->pattern.rows(), static_cast<double>(factor_bytes_) * 1e-9,
                        static_cast<double>(most_bytes) * 1e-9));
    wait_detached([shared, factored = factored_] { factored->factorize(*shared); }, run);
    rows_.resize(shared->fixed.size());
    for (std::size_t n = 0; n < rows_.size(); ++n) rows_[n] = factored_->pattern.dof(static_cast<NodeIndex>(n));
    row_count_ = static_cast<std::int64_t>(factored_->pattern.rows());
}

Eigen::MatrixXd FactoredSystem::solve(Eigen::MatrixXd loads, const RunControl& run) const {
    if (loads.rows() == 0) return loads;
    return run_detached([factored = factored_, b = std::move(loads)] { return factored->solver.solve(b); }, run);
}

}  // namespace fretwork
