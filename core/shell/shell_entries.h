// Inside of VOXELIZE: patches -> one entry per cell and sheet.
#pragma once

#include <cstdint>
#include <vector>

#include "core/base/run_control.h"
#include "core/shell/cut_mesh.h"
#include "core/shell/links.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Fills everything of `shell` but `adjacency` and `components`; `shell.grid` must be set.
/// \return the triangles of each entry
EntryTriangles make_entries(const GriddedMesh& mesh, const LayeredPatches& patches, SurfaceVoxels& shell,
                            const RunControl& run);

/// Entries that hold nothing but triangles without area have no normal yet. They take the mean of their neighbours,
/// spreading from entry to entry over `links`; +z where there is none in reach.
void fill_missing_normals(const TouchingEntries& touching, const TouchingLinks& links, std::vector<Vec3f>& normals);

/// Component of each entry; components are numbered in the order of their lowest triangle.
std::vector<std::uint32_t> components_by_lowest_triangle(const Adjacency& adjacency, const EntryTriangles& triangles);

}  // namespace fretwork
