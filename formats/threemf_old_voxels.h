// Voxel data that an earlier carve has left in a package.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "formats/threemf_layout.h"

namespace fretwork::threemf {

struct OldVoxels {
    std::vector<TextSpan> elements;   ///< of the model part, each with the end of its line
    std::vector<std::string> sheets;  ///< paths of pictures, with a leading slash
};

/// Volume data, functions and image stacks of these objects that Fretwork wrote (they hold `fw:` properties, and their
/// sheets lie where ours do) and nothing else of the part refers to. None in a part with implicit functions, which may
/// refer to anything.
/// Cost  one pass over the text, if any of the objects has volume data.
OldVoxels old_voxels_of(std::string_view xml, const ModelLayout& layout, const std::set<ResourceId>& carved);

}  // namespace fretwork::threemf
