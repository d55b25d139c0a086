// What a layer rests on. Internal to this folder and its tests.
#pragma once

#include <vector>

#include "core/printability/layers.h"
#include "core/printability/printability.h"

namespace fretwork {

struct LayerSupports {
    std::vector<PrintPlace> islands;  ///< parts that rest on nothing
    double overhang_mm2 = 0.0;
    PrintPlace longest_bridge, longest_cantilever;
};

/// \param reach_mm  how far a layer may reach over the one below before it counts as hanging
LayerSupports look_below(const Layer& layer, const Layer& below, double reach_mm);

}  // namespace fretwork
