// Where labels come from before they are optimised: the start, UPSAMPLE and JITTER of Algorithm 2.
#pragma once

#include <cstdint>
#include <span>

#include "core/synthesis/synthesis_problem.h"

namespace fretwork {

/// Label (0, 0) everywhere, line 1 of Algorithm 2.
Choices constant_labels(const SynthesisProblem& problem, const ProblemLevel& level);

/// A random label within the cone and along the field for every voxel.
Choices random_labels(const SynthesisProblem& problem, const ProblemLevel& level);

/// UPSAMPLE: every voxel takes the label of its parent.
Choices upsample(const SynthesisProblem& problem, const ProblemLevel& level, const Choices& coarser);

/// JITTER: the share `settings.jitter` of the voxels, picked at random, takes random labels.
void jitter(const SynthesisProblem& problem, const ProblemLevel& level, Choices& choices);

}  // namespace fretwork
