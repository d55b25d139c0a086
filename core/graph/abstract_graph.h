// G_abstract = (S, F): the pattern as about a thousand samples and what connects, or could connect, them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

using SampleIndex = std::uint32_t;
using EdgeIndex = std::uint32_t;
inline constexpr SampleIndex kNoSample = 0xffffffffu;

/// rho(f) of the paper.
enum class EdgeState : std::uint8_t {
    kEmpty = 0,  ///< the path crosses empty voxels: a bridge could be built there
    kSolid = 1,  ///< the path runs through the pattern
};

struct AbstractEdge {
    SampleIndex a = 0, b = 0;  ///< a < b
    EdgeState state = EdgeState::kEmpty;
    float length_voxels = 0.0f;  ///< of the whole path
    float gap_voxels = 0.0f;     ///< of its part over empty voxels; 0 for solid edges
};

struct AbstractGraph {
    std::vector<VoxelIndex> samples;        ///< S, ascending
    std::vector<AbstractEdge> edges;        ///< F, by (a, b); each pair at most once
    std::vector<std::uint32_t> first_path;  ///< compressed rows into `path`, one per edge
    std::vector<VoxelIndex> path;           ///< from sample a to sample b, both included, each step a link of G_surface
    /// Sample whose tree each voxel of the shell belongs to, over solid first and then over all of
    /// G_surface. kNoSample on components of the shell without a sample.
    std::vector<SampleIndex> owner;

    [[nodiscard]] std::span<const VoxelIndex> voxel_path(EdgeIndex e) const {
        return {path.data() + first_path[e], path.data() + first_path[e + 1]};
    }
};

}  // namespace fretwork
