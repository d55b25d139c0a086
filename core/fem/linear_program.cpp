#include "core/fem/linear_program.h"

#include <glpk.h>

#include <algorithm>
#include <vector>

#include "core/base/error.h"

namespace fretwork {
namespace {

/// GLPK ends the process where a number is none.
void check_finite(const Eigen::Ref<const Eigen::MatrixXd>& numbers) {
    if (!numbers.allFinite()) throw SolverFailure("linear program: an entry is not finite");
}

struct Delete {
    void operator()(glp_prob* problem) const { glp_delete_prob(problem); }
};

}  // namespace

struct LinearProgram::Impl {
    std::unique_ptr<glp_prob, Delete> problem{glp_create_prob()};
    bool feasible = false;

    void set_equations(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);
    /// GLP_OPT, GLP_NOFEAS, GLP_UNBND ...
    int solve();
};

void LinearProgram::Impl::set_equations(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) {
    glp_prob* lp = problem.get();
    glp_set_obj_dir(lp, GLP_MAX);
    const auto rows = static_cast<int>(A.rows()), columns = static_cast<int>(A.cols());
    glp_add_rows(lp, rows);
    glp_add_cols(lp, columns);
    // It counts from 1.
    for (int i = 0; i < rows; ++i) glp_set_row_bnds(lp, i + 1, GLP_FX, b[i], b[i]);
    std::vector<int> row_numbers(static_cast<std::size_t>(rows) + 1);
    std::vector<double> values(row_numbers.size());
    for (int j = 0; j < columns; ++j) {
        glp_set_col_bnds(lp, j + 1, GLP_LO, 0.0, 0.0);
        int filled = 0;
        for (int i = 0; i < rows; ++i) {
            if (A(i, j) == 0.0) continue;
            ++filled;
            row_numbers[static_cast<std::size_t>(filled)] = i + 1;
            values[static_cast<std::size_t>(filled)] = A(i, j);
        }
        glp_set_mat_col(lp, j + 1, filled, row_numbers.data(), values.data());
    }
    glp_std_basis(lp);
}

int LinearProgram::Impl::solve() {
    glp_smcp settings;
    glp_init_smcp(&settings);
    settings.msg_lev = GLP_MSG_OFF;
    settings.tol_bnd = settings.tol_dj = 1e-10;
    if (glp_simplex(problem.get(), &settings) != 0) throw SolverFailure("linear program: the solver gave up");
    return glp_get_status(problem.get());
}

LinearProgram::LinearProgram(const Eigen::MatrixXd& A, const Eigen::VectorXd& b) : impl_(std::make_unique<Impl>()) {
    check_finite(A);
    check_finite(b);
    impl_->set_equations(A, b);
    impl_->feasible = impl_->solve() == GLP_OPT;
}

LinearProgram::~LinearProgram() = default;
LinearProgram::LinearProgram(LinearProgram&&) noexcept = default;
LinearProgram& LinearProgram::operator=(LinearProgram&&) noexcept = default;

bool LinearProgram::feasible() const {
    return impl_->feasible;
}

Eigen::VectorXd LinearProgram::maximize(const Eigen::VectorXd& c) {
    if (!feasible()) throw SolverFailure("linear program: no solution meets its equations");
    check_finite(c);
    const double largest = c.cwiseAbs().maxCoeff(), size = largest > 0.0 ? largest : 1.0;
    glp_prob* lp = impl_->problem.get();
    for (int j = 0; j < c.size(); ++j) glp_set_obj_coef(lp, j + 1, c[j] / size);
    if (impl_->solve() != GLP_OPT) throw SolverFailure("linear program: the aim has no upper bound");
    Eigen::VectorXd x(c.size());
    for (int j = 0; j < c.size(); ++j) x[j] = std::max(0.0, glp_get_col_prim(lp, j + 1));
    return x;
}

}  // namespace fretwork
