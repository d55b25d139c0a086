// Stage 5e: an object that nothing holds: how it gives way to forces in balance, and how it sways.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/fem/beam_system.h"
#include "core/fem/equilibrium_solver.h"
#include "core/fem/stiffness_pattern.h"

namespace fretwork {

/// Vectors have three entries per node, x y z; one column per load or mode.
class FreeBody {
  public:
    /// Each piece rests on six springs, at the six freedoms that tell its rigid motions apart best: forces in balance
    /// leave them without load, so that the rest strains as if nothing were there.
    /// \param system   must outlive it
    /// \param factors  of `BeamSystem::factors`
    /// \param mass     per node, in any unit; above 0
    /// \throws SolverFailure  the equations are singular.
    FreeBody(const BeamSystem& system, std::span<const double> factors, const std::vector<double>& mass,
             const RunControl& run = {});
    FreeBody(const FreeBody&) = delete;  // the solver looks at the pattern beside it
    FreeBody& operator=(const FreeBody&) = delete;
    ~FreeBody() = default;

    /// Displacements in mm, up to a rigid motion of each piece, under forces on each piece that are in balance.
    [[nodiscard]] Eigen::MatrixXd displacements(const Eigen::MatrixXd& forces_n) const;

    [[nodiscard]] const Eigen::VectorXd& mass() const { return mass_; }            ///< per freedom
    [[nodiscard]] const Eigen::MatrixXd& rigid_motions() const { return rigid_; }  ///< M-orthonormal, six per piece

  private:
    Eigen::VectorXd mass_;
    Eigen::MatrixXd rigid_;
    StiffnessPattern pattern_;
    EquilibriumSolver solver_;
};

/// K u = lambda M u, the softest first; shapes of unit mass without rigid motion.
struct Modes {
    Eigen::VectorXd lambda;  ///< N/mm per unit of mass
    Eigen::MatrixXd shape;
};

/// The lowest modes that are not rigid motions, by Spectra's restarted Lanczos method on the inverse, from which rigid
/// motions are taken out; each to a residual of a thousandth. Fewer than `count` where the object has no more, or they
/// do not settle. Cost  some ten solutions for each mode: 1 s for twelve of 43,000 freedoms.
/// \throws Cancelled  `run` asked to stop.
Modes lowest_modes(const FreeBody& body, int count, const RunControl& run = {});

}  // namespace fretwork
