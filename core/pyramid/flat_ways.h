// Inside of the pyramid: ways to neighbours on a smooth surface, eight at a time.
#pragma once

#include <cstdint>

#include "core/pyramid/voxel_pyramid.h"

namespace fretwork {

/// Pairs whose normals, and all on the way, have at least this cosine lie on a smooth piece of the surface.
inline constexpr float kSmoothCosine = 0.8F;

/// Position and normal of an entry side by side.
struct alignas(32) SurfaceFrame {
    float position[4];
    float normal[4];
};

/// The way out and the way back (see NeighborBlock) between v and each lane's neighbour: the chord is turned into the
/// tangent plane and stretched to the arc.
///
/// \param unit   1/4096 cells per unit of the positions
/// \param block  its neighbours are set; the ways are written
/// \return the lanes whose normals have a cosine below kSmoothCosine, as bits; what is written there is of no use
using LayFlat = std::uint32_t (*)(const SurfaceFrame* frames, VoxelIndex v, float unit, NeighborBlock& block);

/// Both give the same bits.
std::uint32_t lay_flat_portable(const SurfaceFrame* frames, VoxelIndex v, float unit, NeighborBlock& block);
std::uint32_t lay_flat_avx2(const SurfaceFrame* frames, VoxelIndex v, float unit, NeighborBlock& block);

/// A coordinate of an offset in 1/4096 of a cell.
[[nodiscard]] std::int32_t offset_to_fixed(float coordinate, float unit);

}  // namespace fretwork
