// How far two surfaces are apart: for tests and reports.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"

namespace fretwork {

struct MeshDistanceSettings {
    std::size_t samples = 100'000;  ///< on each surface, by area; its vertices are added. Range [1, 2^32)
    std::uint64_t seed = 1;
};

struct OneSidedDistance {
    double max_mm = 0.0;
    double mean_mm = 0.0;  ///< over the samples by area, without the vertices
    double root_mean_square_mm = 0.0;
};

struct MeshDistance {
    OneSidedDistance from_first;   ///< points of the first mesh to the second surface
    OneSidedDistance from_second;  ///< and the other way

    /// Symmetric Hausdorff distance, from below: the samples may miss the farthest point.
    [[nodiscard]] double max_mm() const {
        return from_first.max_mm > from_second.max_mm ? from_first.max_mm : from_second.max_mm;
    }
};

/// Distances from sampled points of each surface to the other. The samples depend on the seed and their number only,
/// not on the number of threads.
/// Cost  a few microseconds per sample and vertex.
/// \throws InvalidInput    a mesh that cannot be used (see check_mesh.h).
/// \throws InvalidSetting  no samples.
/// \throws Cancelled       `run` asked to stop.
MeshDistance mesh_distance(const TriangleMesh& first, const TriangleMesh& second,
                           const MeshDistanceSettings& settings = {}, const RunControl& run = {});

}  // namespace fretwork
