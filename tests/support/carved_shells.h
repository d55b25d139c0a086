// Shells with patterns on them, made without synthesis: states are functions of position.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork::testing {

/// Solid where sin of the position along `direction` is positive: bands, each half of `period_voxels` wide.
SolidStates stripes(const SurfaceVoxels& shell, double period_voxels, const Vec3& direction = Vec3::UnitZ());

/// Solid in balls around the points of a cubic lattice: loose dots on the surface.
SolidStates dots(const SurfaceVoxels& shell, double period_voxels, double radius_voxels);

/// Solid where a sum of random waves is positive: blobs and strands of all widths, some tiny.
SolidStates blobs(const SurfaceVoxels& shell, double period_voxels, std::uint64_t seed);

/// Every voxel solid with the given probability, on its own: dust.
SolidStates dust(const SurfaceVoxels& shell, double probability, std::uint64_t seed);

}  // namespace fretwork::testing
