// Inside of VOXELIZE: which cells one triangle touches, and what of it lies in each of them.
//
// Everything here is in grid coordinates: one voxel is 1, cell (i, j, k) is [i, i + 1] x ... .
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/base/vec.h"
#include "core/mesh/triangle_mesh.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Coordinates are rounded when a mesh is laid into the grid; surfaces that come this close to a cell,
/// in voxels, count as touching it. Large against rounding (about 1e-12), small against any feature.
inline constexpr double kTouchVoxels = 1e-9;

using Corners = std::array<Vec3, 3>;

/// A mesh laid into the grid.
struct GriddedMesh {
    std::span<const Triangle> triangles;
    std::vector<Vec3> points;   ///< vertices
    std::vector<Vec3> normals;  ///< of the triangles, unit; zero where a triangle has no area

    [[nodiscard]] Corners corners(std::uint32_t t) const {
        return {points[triangles[t][0]], points[triangles[t][1]], points[triangles[t][2]]};
    }
};

/// `mesh` must outlive the result.
GriddedMesh lay_into_grid(const TriangleMesh& mesh, const VoxelGrid& grid);

/// The part of one triangle inside one closed cell.
struct Patch {
    std::uint32_t z;
    std::uint32_t row_x;     ///< y * extent x + x
    std::uint32_t triangle;  ///< index in the mesh
    float area;              ///< in square voxels; half of it where the patch lies in the face between two cells
    Vec3f closest;           ///< its point closest to the cell's centre, relative to that centre
    Vec3f centroid;          ///< its centre of area, relative to the cell's centre; `closest` without an area
};

/// Exact up to kTouchVoxels: does the triangle meet the closed unit cube around `center`? The thirteen
/// axes of \cite akenine2001triangle; a degenerate triangle is treated as the segment or point it is.
[[nodiscard]] bool triangle_meets_cell(const Corners& triangle, const Vec3& center);

/// The same for the segment from `a` to `b`, with its six axes.
[[nodiscard]] bool segment_meets_cell(const Vec3& a, const Vec3& b, const Vec3& center);

/// Appends the patch of every cell that triangle `index` meets and whose z is in [z_begin, z_end), in the
/// order of (z, y, x).
///
/// Cost: proportional to the cells found, also for long and thin triangles.
/// \throws Cancelled  `run` asked to stop.
void cut_triangle(const GriddedMesh& mesh, std::uint32_t index, const VoxelCoord& extent, int z_begin, int z_end,
                  std::vector<Patch>& patches, const RunControl& run);

}  // namespace fretwork
