// Stage 5b: a load case on the shell -> forces and supports on the samples.
#pragma once

#include <cstdint>
#include <vector>

#include "core/fem/force_profile.h"
#include "core/fem/material.h"
#include "core/graph/abstract_graph.h"

namespace fretwork {

/// Pieces of the abstract graph over edges of either state, named by their lowest sample.
std::vector<SampleIndex> piece_of_samples(const AbstractGraph& graph);

struct SampleLoads {
    std::vector<Vec3> force_n;        ///< per sample
    std::vector<std::uint8_t> fixed;  ///< per sample, nonzero for those that cannot move
};

/// Self-weight  area of the solid voxels in a sample's tree x thickness x density x acceleration; or, with
///              `constant_per_sample`, the weight of the whole pattern in equal parts.
/// Patches      each voxel hands its share to the sample whose tree it belongs to, also where it is empty.
/// Supports     samples on fixed voxels. A piece of the abstract graph without one is held at the samples
///              nearest to the fixed voxels on it, or, if there are none, at the lowest tenth of its height,
///              so that nothing moves freely.
SampleLoads loads_on_samples(const SurfaceVoxels& shell, const SolidStates& solid, const AbstractGraph& graph,
                             const LoadCase& load_case, const Material& material, double thickness_mm);

}  // namespace fretwork
