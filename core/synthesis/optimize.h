// OPTIMIZE of the paper, Algorithm 3.
#pragma once

#include <cstdint>
#include <span>

#include "core/base/run_control.h"
#include "core/synthesis/forced_solid.h"
#include "core/synthesis/subpasses.h"
#include "core/synthesis/synthesis_problem.h"

namespace fretwork {

/// One visit to each of the listed voxels, sub-pass by sub-pass: within one, all voxels read the
/// choices as the last one left them and the new choices are written when all are known.
/// \param voxels  of `level`
/// \param epoch   a number of its own for every pass of a run
void optimize_pass(const SynthesisProblem& problem, const ProblemLevel& level, const Subpasses& voxels,
                   const ForcedSolid& forced, std::uint32_t epoch, Choices& choices, const RunControl& run);

/// Sum over the level of the energy of the choices, in the paper's units.
double total_energy(const SynthesisProblem& problem, const ProblemLevel& level, const Choices& choices);

}  // namespace fretwork
