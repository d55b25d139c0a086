// [[keep]] and [[carve]] -> what may not be carved.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/region.h"
#include "core/pipeline/prepare_surface.h"
#include "core/pipeline/settings.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// What regions may refer to in the model as it was read.
struct FileTriangles {
    std::size_t count = 0;
    const std::vector<NamedTriangles>& named;
};

/// The settings with what speaks of the file (triangle sets, names, volumes) turned to the surface that is carved.
/// \throws InvalidSetting   a triangle or name that the file does not have, or none of a set left
Settings regions_on(const PreparedSurface& surface, const FileTriangles& file, Settings settings);

/// The regions of [[keep]], and the complement of those of [[carve]] where there are any.
/// \throws InvalidSetting  a region that meets no part of the surface, by name.
RegionField keep_regions(const TriangleMesh& mesh, const Settings& settings);

/// One byte per voxel: 1 where `field` is negative at the voxel's surface point.
std::vector<std::uint8_t> voxels_inside(const SurfaceVoxels& shell, const RegionField& field,
                                        const RunControl& run = {});

/// Indices of the voxels inside, ascending.
std::vector<VoxelIndex> voxel_list_inside(const SurfaceVoxels& shell, const RegionField& field,
                                          const RunControl& run = {});

}  // namespace fretwork
