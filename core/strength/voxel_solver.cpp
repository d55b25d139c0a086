#include "core/strength/voxel_solver.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 32768;
constexpr int kMostIterations = 500;

double dot(const NodeValues<double>& a, const NodeValues<double>& b) {
    return sum_in_fixed_order(a.size(), kGrain, 0.0, [&](std::size_t i) { return a[i] * b[i]; });
}
double dot(const NodeValues<float>& a, const NodeValues<double>& b) {
    return sum_in_fixed_order(a.size(), kGrain, 0.0, [&](std::size_t i) { return double{a[i]} * b[i]; });
}

FactoredSystem::Elements whole_elements(const VoxelModel& model, const CubeElement& cube,
                                        const std::vector<std::uint8_t>& fixed) {
    FactoredSystem::Elements elements;
    for (const auto& corners : model.corners) elements.nodes.add(corners);
    elements.fixed = fixed;
    elements.kinds = {cube.stiffness};
    elements.kind.assign(model.corners.size(), 0);
    return elements;
}

}  // namespace

/// One right-hand side on its way. z is float: the preconditioner's answer.
struct VoxelSolver::Iterate {
    NodeValues<double> x, r, p, Kp;
    NodeValues<float> z, left;  ///< `left`: the scaled residual that the smoother has not removed
    double norm = 0.0;          ///< of r; what z is scaled by
    double rz = 0.0, alpha = 0.0;
    int iterations = 0;
    bool done = false;

    explicit Iterate(const NodeValues<double>& b)
        : x(b.size()), r(b), p(b.size()), Kp(b.size()), z(b.size()), left(b.size()) {
        std::ranges::fill(x, 0.0);
        std::ranges::fill(p, 0.0);
        std::ranges::fill(Kp, 0.0);
    }
};

VoxelSolver::VoxelSolver(const VoxelModel& model, const CubeElement& cube, std::vector<std::uint8_t> fixed,
                         const SolverSettings& settings, const RunControl& run)
    : fixed_(std::move(fixed)), settings_(settings), fine_(model, cube, fixed_) {
    const bool small = model.voxels.size() < settings.factor_below_voxels;
    if (settings.by == SolveBy::kFactor || (settings.by == SolveBy::kChoice && small))
        whole_ = std::make_unique<FactoredSystem>(whole_elements(model, cube, fixed_), settings.most_factor_bytes, run);
    else
        coarse_ = std::make_unique<CoarseLevel>(model, cube, fixed_, fine_.slabs(), settings.most_factor_bytes, run);
}

VoxelSolver::~VoxelSolver() = default;

std::size_t VoxelSolver::factor_bytes() const {
    return coarse_ ? coarse_->factor_bytes() : whole_->factor_bytes();
}

std::vector<VoxelSolution> VoxelSolver::solve_by_factor(const std::vector<NodeValues<double>>& force_n,
                                                        const RunControl& run) const {
    Eigen::MatrixXd loads(whole_->rows(), static_cast<Eigen::Index>(force_n.size()));
    const auto for_each_row = [&](const auto& use) {
        for (std::size_t n = 0; n < fixed_.size(); ++n)
            for (std::size_t axis = 0; axis < 3 && fixed_[n] == 0; ++axis)
                use(whole_->row(n) + static_cast<Eigen::Index>(axis), 3 * n + axis);
    };
    for (std::size_t k = 0; k < force_n.size(); ++k)
        for_each_row(
            [&](Eigen::Index row, std::size_t i) { loads(row, static_cast<Eigen::Index>(k)) = force_n[k][i]; });
    const Eigen::MatrixXd u = whole_->solve(std::move(loads), run);
    std::vector<VoxelSolution> solutions(force_n.size());
    for (std::size_t k = 0; k < force_n.size(); ++k) {
        solutions[k].displacement_mm.resize(3 * fixed_.size());
        std::ranges::fill(solutions[k].displacement_mm, 0.0);
        for_each_row([&](Eigen::Index row, std::size_t i) {
            solutions[k].displacement_mm[i] = u(row, static_cast<Eigen::Index>(k));
        });
    }
    return solutions;
}

void VoxelSolver::precondition(std::vector<Iterate>& iterates, const RunControl& run) const {
    NodeValues<float> d(3 * fixed_.size()), w(3 * fixed_.size());
    std::vector<Iterate*> active;
    for (Iterate& it : iterates)
        if (!it.done) active.push_back(&it);
    Eigen::MatrixXd coarse(coarse_->rows(), static_cast<Eigen::Index>(active.size()));
    for (std::size_t k = 0; k < active.size(); ++k) {
        Iterate& it = *active[k];
        parallel_for(it.r.size(), kGrain, [&](std::size_t i) {
            it.left[i] = static_cast<float>(it.r[i] / it.norm);
            it.z[i] = 0.0F;
        });
        run.throw_if_stopped();
        fine_.smooth(it.z, it.left, d, w);
        coarse.col(static_cast<Eigen::Index>(k)) = coarse_->restricted(it.left);
    }
    coarse = coarse_->solve(std::move(coarse), run);
    for (std::size_t k = 0; k < active.size(); ++k) {
        Iterate& it = *active[k];
        run.throw_if_stopped();
        coarse_->prolonged(coarse.col(static_cast<Eigen::Index>(k)), d);
        fine_.apply(d, w);
        parallel_for(it.z.size(), kGrain, [&](std::size_t i) {
            it.z[i] += d[i];
            it.left[i] -= w[i];
        });
        fine_.smooth(it.z, it.left, d, w);
    }
}

void VoxelSolver::step(Iterate& it, const NodeValues<double>& force_n) const {
    const double rz = it.norm * dot(it.z, it.r);
    // r - r_before = -alpha K p, so that (r - r_before).z needs no older residual.
    const double beta = it.iterations == 0 ? 0.0 : -it.alpha * it.norm * dot(it.z, it.Kp) / it.rz;
    it.rz = rz;
    parallel_for(it.p.size(), kGrain, [&](std::size_t i) { it.p[i] = it.norm * double{it.z[i]} + beta * it.p[i]; });
    fine_.apply(it.p, it.Kp);
    it.alpha = dot(it.p, it.r) / dot(it.p, it.Kp);
    parallel_for(it.x.size(), kGrain, [&](std::size_t i) {
        it.x[i] += it.alpha * it.p[i];
        it.r[i] -= it.alpha * it.Kp[i];
    });
    ++it.iterations;
    // r.z stands for the squared error before this step in the norm of K, f.x for the solution's.
    it.norm = std::sqrt(dot(it.r, it.r));
    it.done = it.norm == 0.0 || rz <= settings_.tolerance * settings_.tolerance * dot(force_n, it.x);
}

std::vector<VoxelSolution> VoxelSolver::solve(const std::vector<NodeValues<double>>& force_n,
                                              const RunControl& run) const {
    if (whole_) return solve_by_factor(force_n, run);
    std::vector<Iterate> iterates;
    for (const NodeValues<double>& force : force_n) {
        Iterate& it = iterates.emplace_back(force);
        for (std::size_t n = 0; n < fixed_.size(); ++n)
            if (fixed_[n] != 0) it.r[3 * n] = it.r[3 * n + 1] = it.r[3 * n + 2] = 0.0;
        it.norm = std::sqrt(dot(it.r, it.r));
        it.done = it.norm == 0.0;
    }
    for (int turn = 0; !std::ranges::all_of(iterates, &Iterate::done); ++turn) {
        if (turn == kMostIterations)
            throw SolverFailure(fmt::format("strength: no convergence in {} iterations", kMostIterations));
        precondition(iterates, run);
        for (std::size_t k = 0; k < iterates.size(); ++k) {
            run.throw_if_stopped();
            if (!iterates[k].done) step(iterates[k], force_n[k]);
        }
        run.checkpoint("strength", 1.0 - 1.0 / (1.0 + 0.1 * turn));
    }
    std::vector<VoxelSolution> solutions;
    for (Iterate& it : iterates) solutions.push_back({std::move(it.x), it.iterations});
    return solutions;
}

Vec3 VoxelSolver::reaction_n(const NodeValues<double>& displacement_mm, const NodeValues<double>& force_n) const {
    NodeValues<double> Ku(displacement_mm.size());
    fine_.apply_everywhere(displacement_mm, Ku);
    Vec3 sum = Vec3::Zero();
    for (std::size_t n = 0; n < fixed_.size(); ++n)
        for (std::size_t axis = 0; axis < 3 && fixed_[n] != 0; ++axis)
            sum[static_cast<int>(axis)] += Ku[3 * n + axis] - force_n[3 * n + axis];
    return sum;
}

}  // namespace fretwork
