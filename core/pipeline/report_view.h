// Meshes that show what is known of each surface voxel: for pictures and for a light 3D view.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/shell/surface_voxels.h"
#include "core/solidify/solidify.h"

namespace fretwork {

/// A mesh and the surface voxel that each triangle stands for.
struct VoxelView {
    TriangleMesh mesh;
    std::vector<std::uint32_t> triangle_voxels;
};

/// The surface in triangles that are as small as voxels, or as small as some two million of them allow.
/// Cost  about a second and 200 bytes per million triangles
/// \throws Cancelled
VoxelView fine_surface(const TriangleMesh& surface, const SurfaceVoxels& shell, const RunControl& run = {});

/// Those triangles whose voxels are solid: the pattern as a thin sheet.
VoxelView solid_part(const VoxelView& view, const SolidStates& solid);

/// A mesh of the vertices of another, with a colour each.
struct LightView {
    VoxelView view;
    std::vector<Rgb8> vertex_colors;  ///< sRGB; the mean of the triangles around the vertex before it became light
};

/// The carved mesh in no more than about `most_triangles`, as far as it stays a valid mesh.
/// \param plain  the colour where the carved mesh has none
/// \throws Cancelled
LightView light_view(const CarvedMesh& carved, double voxel_mm, std::size_t most_triangles, const Rgb8& plain,
                     const RunControl& run = {});

}  // namespace fretwork
