// Stage 4c: samples of the pattern, the vertices S of the abstract graph (section 5.1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/shell/components.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

struct SampleSettings {
    std::size_t target = 1000;  ///< samples over the whole shell; the paper uses 500 to 1000
    std::size_t least = 24;     ///< wanted on each component of the shell, if it has that many solid voxels
    double tolerance = 0.05;    ///< accepted departure from the target, relative
    std::uint64_t seed = 1;
    /// Radius to try first, per component of the shell: that of an earlier, similar pattern. May be empty.
    std::vector<double> start_radius_voxels;
    double start_tolerance = 0.15;  ///< accepted for it, relative
};

struct Samples {
    std::vector<VoxelIndex> voxels;     ///< ascending
    std::vector<double> radius_voxels;  ///< per component of the shell
};

/// Poisson-disk samples of the solid voxels: on each component of the shell a radius r is found by
/// bisection so that about the component's share of `target` results. Distances are paths through solid,
/// unlike \cite bowers2010parallel, so that every piece of the pattern has a sample, however close
/// another piece lies.
///
/// Promise  two samples are more than r apart, and no solid voxel is more than r from the nearest one.
///          The target is missed only where the pattern has more pieces than that (one sample each)
///          or fewer voxels, or where no radius meets it.
/// Cost     about six passes over the solid links.
/// \param shell_components  components of `graph` itself
/// \throws InvalidSetting  a target of 0.
/// \throws Cancelled       `run` asked to stop.
Samples poisson_samples(const Adjacency& graph, const ShellComponents& shell_components, const SolidStates& solid,
                        const SampleSettings& settings, const RunControl& run = {});

}  // namespace fretwork
