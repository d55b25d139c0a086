// A reinforcement bridge: an empty edge of the abstract graph that becomes solid (section 5.2).
#pragma once

#include <cstdint>
#include <vector>

#include "core/graph/abstract_graph.h"

namespace fretwork {

enum class BridgeReason : std::uint8_t {
    kConnect,   ///< joins two pieces of the pattern
    kStress,    ///< score of the force profile
    kGeodesic,  ///< a long way round through the pattern
};

struct Bridge {
    EdgeIndex edge = 0;
    BridgeReason reason = BridgeReason::kStress;
};

}  // namespace fretwork
