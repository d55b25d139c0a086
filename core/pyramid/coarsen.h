// Inside of the pyramid: one level -> the next coarser one.
#pragma once

#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/pyramid/voxel_pyramid.h"

namespace fretwork {

/// A level while it is being built: it also knows the surface that each entry stands for.
struct WeightedLevel {
    PyramidLevel level;
    std::vector<float> area_voxels2;
    std::vector<Vec3f> facing;     ///< sum of areas along their normals, unrounded
    std::vector<Vec3f> centroids;  ///< of the surface, in the unit of the positions
};

/// Children of one cell of the coarser level that hang together by links inside this cell make one entry.
/// Position and normal are those of the surface that all children enclose, its centre of area and the direction of the
/// sum of its areas, so that they do not depend on how fine the finest level is; where the areas cancel, the child with
/// the largest one decides. Entries are linked when children of theirs are, or around a common neighbour as in
/// the shell.
///
/// Sets `parent` of `fine` and everything but `neighborhoods` of the result. Linear.
/// \param level_index  of the result; 0 is the finest level
WeightedLevel coarsen(WeightedLevel& fine, int level_index, const RunControl& run);

}  // namespace fretwork
