// Stage 10b: K u = f over all voxels. Internal to this folder and its tests.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "core/base/run_control.h"
#include "core/strength/coarse_level.h"
#include "core/strength/fine_level.h"
#include "core/strength/solve_by.h"

namespace fretwork {

struct SolverSettings {
    SolveBy by = SolveBy::kChoice;
    double tolerance = 1e-5;  ///< of the error in the energy norm against the solution's; range 1e-12 to 0.1
    std::size_t factor_below_voxels = 10000;
    std::size_t most_factor_bytes = std::size_t{2} << 30;
};

struct VoxelSolution {
    NodeValues<double> displacement_mm;
    int iterations = 0;  ///< 0: by a factor
};

/// Several right-hand sides for one set of supports. What takes longer than 0.1 s runs detached.
///
/// The preconditioner is one cycle: smooth in single precision, solve on the coarse level in double, smooth again. The
/// residual is scaled to a norm of 1 before it and beta takes the form of Polak and Ribiere, because single precision
/// is not exactly linear. Bits do not depend on the number of threads.
class VoxelSolver {
  public:
    /// \param model  must outlive the solver
    /// \param fixed  per node; every piece must be held
    /// \throws MemoryLimit, Cancelled, SolverFailure  see FactoredSystem
    VoxelSolver(const VoxelModel& model, const CubeElement& cube, std::vector<std::uint8_t> fixed,
                const SolverSettings& settings, const RunControl& run);
    ~VoxelSolver();

    /// \param force_n  x, y, z per node; what acts on fixed nodes goes into the supports
    /// \throws SolverFailure  no convergence in 500 iterations
    [[nodiscard]] std::vector<VoxelSolution> solve(const std::vector<NodeValues<double>>& force_n,
                                                   const RunControl& run) const;

    /// K u - f where nodes are fixed, summed: what the supports push back with.
    [[nodiscard]] Vec3 reaction_n(const NodeValues<double>& displacement_mm, const NodeValues<double>& force_n) const;

    [[nodiscard]] SolveBy by() const { return coarse_ ? SolveBy::kMultigrid : SolveBy::kFactor; }
    [[nodiscard]] std::size_t factor_bytes() const;

  private:
    struct Iterate;
    [[nodiscard]] std::vector<VoxelSolution> solve_by_factor(const std::vector<NodeValues<double>>& force_n,
                                                             const RunControl& run) const;
    void precondition(std::vector<Iterate>& iterates, const RunControl& run) const;
    void step(Iterate& iterate, const NodeValues<double>& force_n) const;

    std::vector<std::uint8_t> fixed_;
    SolverSettings settings_;
    FineLevel fine_;
    std::unique_ptr<CoarseLevel> coarse_;
    std::unique_ptr<FactoredSystem> whole_;
};

}  // namespace fretwork
