// Voxel data and colours that an earlier carve has left in a package.
#pragma once

#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "formats/threemf_layout.h"

namespace fretwork::threemf {

struct OldCarve {
    std::vector<TextSpan> elements;   ///< of the model part, each with the end of its line
    std::vector<std::string> sheets;  ///< paths of pictures, with a leading slash
    std::set<ResourceId> ids;         ///< of those elements
};

/// Volume data, functions and image stacks of these objects that Fretwork wrote (they hold `fw:` properties, and their
/// sheets lie where ours do), and the colour groups that stand right before those stacks, as far as nothing else of the
/// part refers to them. None in a part with implicit functions, which may refer to anything.
/// Cost  one pass over the text, if any of the objects has volume data.
OldCarve old_carve_of(std::string_view xml, const ModelLayout& layout, const std::set<ResourceId>& carved);

}  // namespace fretwork::threemf
