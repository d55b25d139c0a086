#include "core/fem/equilibrium_solver.h"

#include <cholmod.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <string>
#include <type_traits>

#include "core/base/error.h"

namespace fretwork {
namespace {

static_assert(std::is_same_v<SuiteSparse_long, std::int64_t>);

/// The workspace of the library; every other handle needs it to be freed.
class Common {
  public:
    Common() {
        cholmod_l_start(&value_);
        value_.print = 0;
        value_.try_catch = 1;  // no messages; the status is looked at instead
        value_.supernodal = CHOLMOD_SUPERNODAL;
        value_.nmethods = 1;
        value_.method[0].ordering = CHOLMOD_GIVEN;
        value_.postorder = 1;
    }
    ~Common() { cholmod_l_finish(&value_); }
    Common(const Common&) = delete;
    Common& operator=(const Common&) = delete;
    [[nodiscard]] cholmod_common* get() { return &value_; }

  private:
    cholmod_common value_{};
};

struct FreeFactor {
    cholmod_common* common;
    void operator()(cholmod_factor* factor) const { cholmod_l_free_factor(&factor, common); }
};
using Factor = std::unique_ptr<cholmod_factor, FreeFactor>;

struct FreeDense {
    cholmod_common* common;
    void operator()(cholmod_dense* dense) const { cholmod_l_free_dense(&dense, common); }
};
using Dense = std::unique_ptr<cholmod_dense, FreeDense>;

/// A view of compressed columns as the library's matrix, lower triangle; `values` may be null.
cholmod_sparse sparse_view(const std::vector<std::int64_t>& first, const std::vector<std::int64_t>& row,
                           const double* values) {
    cholmod_sparse A{};
    A.nrow = A.ncol = first.size() - 1;
    A.nzmax = row.size();
    // The library takes pointers to non-const everywhere, but does not write through these.
    A.p = const_cast<std::int64_t*>(first.data());
    A.i = const_cast<std::int64_t*>(row.data());
    A.x = const_cast<double*>(values);
    A.stype = -1;
    A.itype = CHOLMOD_LONG;
    A.xtype = values == nullptr ? CHOLMOD_PATTERN : CHOLMOD_REAL;
    A.dtype = CHOLMOD_DOUBLE;
    A.sorted = 1;
    A.packed = 1;
    return A;
}

[[noreturn]] void fail(const std::string& what, const cholmod_common& common) {
    if (common.status == CHOLMOD_OUT_OF_MEMORY) throw SolverFailure("equilibrium solver: " + what + ": out of memory");
    if (common.status == CHOLMOD_TOO_LARGE) throw SolverFailure("equilibrium solver: " + what + ": problem too large");
    throw SolverFailure("equilibrium solver: " + what + ": status " + std::to_string(common.status));
}

template <class Function>
Function* find_function(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_DEFAULT, name));
}

/// Threaded sums differ with the number of threads. OpenBLAS is told at run time where it is the
/// library in use; others (the reference BLAS) have one thread anyway.
void use_one_blas_thread() {
    if (auto* set_threads = find_function<void(int)>("openblas_set_num_threads"); set_threads != nullptr)
        set_threads(1);
}

/// While it lives, OpenMP regions that the calling thread meets run on that thread alone. The sparse library asks
/// for four threads at every supernode, whatever the machine has: starting and awaiting them costs as much as the
/// factorisation itself.
class SerialOpenMp {
  public:
    SerialOpenMp()
        : get_(find_function<int()>("omp_get_max_active_levels")),
          set_(find_function<void(int)>("omp_set_max_active_levels")),
          levels_(get_ != nullptr ? get_() : 0) {
        if (set_ != nullptr) set_(0);
    }
    ~SerialOpenMp() {
        if (get_ != nullptr && set_ != nullptr) set_(levels_);
    }
    SerialOpenMp(const SerialOpenMp&) = delete;
    SerialOpenMp& operator=(const SerialOpenMp&) = delete;

  private:
    int (*get_)();
    void (*set_)(int);
    int levels_;
};

}  // namespace

struct EquilibriumSolver::Impl {
    const StiffnessPattern& pattern;
    Common common;
    Factor factor;
    bool factored = false;

    explicit Impl(const StiffnessPattern& pattern_in)
        : pattern(pattern_in), factor(nullptr, FreeFactor{common.get()}) {}

    /// Nested dissection of the node graph; the three freedoms of a node stay together.
    std::vector<std::int64_t> ordering() {
        // The library draws its random numbers from one sequence of the process: orderings on two threads at once would
        // disturb each other's.
        static std::mutex one_at_a_time;
        const std::lock_guard lock(one_at_a_time);
        cholmod_sparse nodes = sparse_view(pattern.block_first(), pattern.block_row(), nullptr);
        std::vector<std::int64_t> node_order(pattern.free_nodes());
        if (cholmod_l_metis(&nodes, nullptr, 0, 1, node_order.data(), common.get()) == 0)
            fail("ordering", *common.get());
        std::vector<std::int64_t> order;
        order.reserve(pattern.rows());
        for (const std::int64_t n : node_order)
            for (std::int64_t axis = 0; axis < 3; ++axis) order.push_back(3 * n + axis);
        return order;
    }
};

EquilibriumSolver::EquilibriumSolver(const StiffnessPattern& pattern) : impl_(std::make_unique<Impl>(pattern)) {
    if (pattern.rows() == 0) return;
    use_one_blas_thread();
    const SerialOpenMp serial;
    std::vector<std::int64_t> order = impl_->ordering();
    cholmod_sparse K = sparse_view(pattern.column_first(), pattern.row(), nullptr);
    impl_->factor.reset(cholmod_l_analyze_p(&K, order.data(), nullptr, 0, impl_->common.get()));
    if (!impl_->factor) fail("analysis", *impl_->common.get());
}

EquilibriumSolver::~EquilibriumSolver() = default;
EquilibriumSolver::EquilibriumSolver(EquilibriumSolver&&) noexcept = default;
EquilibriumSolver& EquilibriumSolver::operator=(EquilibriumSolver&&) noexcept = default;

std::size_t EquilibriumSolver::factor_bytes() const {
    return impl_->factor ? impl_->factor->xsize * sizeof(double) : 0;
}

void EquilibriumSolver::factorize(std::span<const double> values) {
    if (impl_->pattern.rows() == 0) return;
    const SerialOpenMp serial;
    cholmod_sparse K = sparse_view(impl_->pattern.column_first(), impl_->pattern.row(), values.data());
    impl_->factored = false;
    if (cholmod_l_factorize(&K, impl_->factor.get(), impl_->common.get()) == 0)
        fail("factorisation", *impl_->common.get());
    if (impl_->common.get()->status == CHOLMOD_NOT_POSDEF || impl_->factor->minor < impl_->factor->n)
        throw SolverFailure("equilibrium solver: the matrix is not positive definite at degree of freedom " +
                            std::to_string(impl_->factor->minor) + " of " + std::to_string(impl_->factor->n) +
                            "; something can move freely");
    impl_->factored = true;
}

Eigen::MatrixXd EquilibriumSolver::solve(const Eigen::MatrixXd& loads_n) const {
    if (impl_->pattern.rows() == 0) return loads_n;
    if (!impl_->factored) throw SolverFailure("equilibrium solver: solve() was called before factorize()");
    const SerialOpenMp serial;
    cholmod_dense b{};
    b.nrow = b.d = static_cast<std::size_t>(loads_n.rows());
    b.ncol = static_cast<std::size_t>(loads_n.cols());
    b.nzmax = b.nrow * b.ncol;
    b.x = const_cast<double*>(loads_n.data());
    b.xtype = CHOLMOD_REAL;
    b.dtype = CHOLMOD_DOUBLE;
    cholmod_common* common = impl_->common.get();
    const Dense u(cholmod_l_solve(CHOLMOD_A, impl_->factor.get(), &b, common), FreeDense{common});
    if (!u) fail("solution", *common);
    return Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(u->x), loads_n.rows(), loads_n.cols());
}

}  // namespace fretwork
