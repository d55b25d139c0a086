// Inside of the pyramid: one level -> the next coarser one.
#pragma once

#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/pyramid/voxel_pyramid.h"

namespace fretwork {

/// A level while it is being built: it also knows how much surface each entry stands for.
struct WeightedLevel {
    PyramidLevel level;
    std::vector<float> area_voxels2;
};

/// Children of one cell of the coarser level that hang together by links inside this cell make one entry.
/// Position and normal are means over the children, weighted by area; where the normals cancel, the child with
/// the largest area decides. Entries are linked when children of theirs are, or around a common neighbour as in
/// the shell.
///
/// Sets `parent` of `fine` and everything but `neighborhoods` of the result. Linear.
WeightedLevel coarsen(WeightedLevel& fine, const RunControl& run);

}  // namespace fretwork
