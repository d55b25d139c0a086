// Stage 4a: the links over which material holds together.
#pragma once

#include "core/shell/components.h"
#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Links between voxels that share a face, and those others without which the shell itself would
/// fall apart. Two voxels that meet only in an edge or a corner are a hinge, so a pattern is in one
/// piece when it is over *these* links.
///
/// The result has the components of `graph` and never more links than it. Cost: linear.
Adjacency firm_links(const Adjacency& graph);

}  // namespace fretwork
