// Makes the solid voxels of each shell component one piece that holds by faces.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/enlarge/geodesic_links.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Face-connected components of a set of voxels over G_surface.
struct FaceComponents {
    std::vector<std::uint32_t> of_voxel;  ///< kOutside where the voxel is not in the set
    std::vector<double> area_voxels;      ///< per component: enclosed surface, in squares of the voxel's side
    static constexpr std::uint32_t kOutside = ~std::uint32_t{0};

    [[nodiscard]] std::size_t count() const { return area_voxels.size(); }
};

/// Whether two linked voxels lie side by side.
bool share_face(const SurfaceVoxels& shell, VoxelIndex a, VoxelIndex b);

FaceComponents face_components(const SurfaceVoxels& shell, const VoxelMask& set);

/// Voxels to be made solid so that no two solid voxels hold together by an edge or a corner alone. Ascending.
/// \param may_change  voxels that may become solid
/// \param at          solid voxels, ascending: of each contact that is looked at, both are among them
std::vector<VoxelIndex> hinge_fillers(const SurfaceVoxels& shell, const VoxelMask& solid, const VoxelMask& may_change,
                                      std::span<const VoxelIndex> at);

struct IslandLinks {
    std::vector<VoxelIndex> path;  ///< voxels on the joining paths, ends included
    std::size_t joined = 0;
};

/// Shortest paths (Kruskal over the Voronoi borders of the pieces) that make one piece per shell component.
IslandLinks link_islands(const SurfaceVoxels& shell, const FaceComponents& pieces, const VoxelMask& may_change,
                         const RunControl& run = {});

}  // namespace fretwork
