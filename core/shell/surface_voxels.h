// The one-voxel shell on which everything between voxelising and thickening works.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/bulk_vector.h"
#include "core/base/vec.h"

namespace fretwork {

using VoxelCoord = std::array<std::int32_t, 3>;
using VoxelIndex = std::uint32_t;

/// Regular grid. Voxel (i, j, k) is the closed cube from origin + (i, j, k) * voxel to the next corner.
struct VoxelGrid {
    Vec3 origin_mm = Vec3::Zero();
    double voxel_mm = 1.0;
    VoxelCoord extent = {0, 0, 0};  ///< voxels along x, y, z

    [[nodiscard]] Vec3 center_mm(const VoxelCoord& c) const {
        return origin_mm + voxel_mm * Vec3(c[0] + 0.5, c[1] + 0.5, c[2] + 0.5);
    }
};

/// Undirected graph in compressed rows: neighbours of v are neighbor[first[v] .. first[v + 1]),
/// ascending. Every edge is stored in both directions.
struct Adjacency {
    std::vector<std::uint32_t> first;
    BulkVector<VoxelIndex> neighbor;
    BulkVector<float> length_voxels;  ///< 1, sqrt 2 or sqrt 3 between cells; 0 within one cell never occurs

    [[nodiscard]] std::span<const VoxelIndex> of(VoxelIndex v) const {
        return {neighbor.data() + first[v], neighbor.data() + first[v + 1]};
    }
};

/// V of the paper, with one entry per cell *and sheet*: where two sheets of the surface pass through
/// one cell without being joined inside it (the two sides of a thin wall), the cell is listed once
/// for each, so that the sheets carry patterns of their own.
///
/// Sorted by (z, y, x), then by the lowest triangle of the sheet. Structure of arrays.
struct SurfaceVoxels {
    VoxelGrid grid;
    std::vector<VoxelCoord> coords;
    std::vector<Vec3f> normals;             ///< unit, outward, area-weighted mean over the enclosed surface
    std::vector<Vec3> points_mm;            ///< point of this sheet closest to the cell's centre
    std::vector<std::uint32_t> triangles;   ///< triangle of the mesh that holds the point
    std::vector<float> area_mm2;            ///< area of the enclosed surface
    std::vector<float> facing_area_mm2;     ///< of its projection along the normal: the length of the sum of its areas
    std::vector<Vec3f> centroids_voxels;    ///< its centre of area from the grid's origin; the point without an area
    std::vector<std::uint32_t> components;  ///< connected component of the mesh, 0, 1, ...
    /// G_surface: cells that touch (by face, edge or corner) and are joined by the surface itself.
    Adjacency adjacency;

    [[nodiscard]] std::size_t size() const { return coords.size(); }
};

/// s(v): one byte per surface voxel.
enum class SolidState : std::uint8_t { kEmpty = 0, kSolid = 1 };
using SolidStates = std::vector<SolidState>;

}  // namespace fretwork
