// Stage 10a: the carved object as cubes, one finite element each. The paper judges its patterns the same way (section
// 7, "full resolution"); its mesher is not described.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/fem/stiffness_pattern.h"
#include "core/mesh/triangle_mesh.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Cubes and the corners that they share, each sorted by (z, y, x).
struct VoxelModel {
    VoxelGrid grid;
    std::vector<VoxelCoord> voxels;
    std::vector<VoxelCoord> nodes;                  ///< corner (i, j, k) lies at origin + (i, j, k) * voxel
    std::vector<std::array<NodeIndex, 8>> corners;  ///< of each voxel, in the order of VTK
    std::vector<std::uint32_t> piece;               ///< of each voxel: what hangs together by faces; 0, 1, ...
    std::uint32_t pieces = 0;
    std::size_t joining_voxels = 0;  ///< added where two pieces met in an edge or corner alone

    [[nodiscard]] Vec3 node_mm(NodeIndex n) const {
        return grid.origin_mm + grid.voxel_mm * Vec3(nodes[n][0], nodes[n][1], nodes[n][2]);
    }
};

/// Voxels whose centres are inside the mesh: the winding number, counted exactly along lines of centres, is above 0.
/// Pieces that touch by an edge or a corner alone would be hinges: they are joined by one voxel or two, which a wall of
/// several voxels never needs. Walls thinner than a voxel may be lost.
/// The grid is centred on the mesh's box and as small as holds it, so that boxes of whole voxels become those voxels.
/// Same result for any number of threads.
/// \param mesh      closed, outward
/// \param voxel_mm  above 0; at most 4096 along the longest side
/// \throws InvalidInput    no triangle, a coordinate that is not finite, or no voxel centre inside.
/// \throws InvalidSetting  `voxel_mm` out of range.
/// \throws Cancelled       `run` asked to stop.
VoxelModel make_voxel_model(const TriangleMesh& mesh, double voxel_mm, const RunControl& run = {});

/// The same from cells that are known, such as a pattern of voxels. \throws InvalidInput  none
VoxelModel make_voxel_model(const VoxelGrid& grid, const std::vector<VoxelCoord>& solid);

}  // namespace fretwork
