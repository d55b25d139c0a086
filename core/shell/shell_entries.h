// Inside of VOXELIZE: patches -> one entry per cell and sheet.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/mesh/triangle_mesh.h"
#include "core/shell/cut_mesh.h"
#include "core/shell/links.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Fills everything of `shell` but `adjacency` and `components`; `shell.grid` must be set.
/// \return the triangles of each entry
EntryTriangles make_entries(std::span<const Triangle> triangles, std::span<const Vec3> grid_points,
                            const LayeredPatches& patches, SurfaceVoxels& shell, const RunControl& run);

/// Component of each entry; components are numbered in the order of their lowest triangle.
std::vector<std::uint32_t> components_by_lowest_triangle(const Adjacency& adjacency, const EntryTriangles& triangles);

}  // namespace fretwork
