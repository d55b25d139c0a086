// G-code of PrusaSlicer and its kin -> what will be printed.
#pragma once

#include <string_view>

#include "formats/sliced_print.h"

namespace fretwork {

/// Follows G0, G1, G90 to G92, M82 and M83 and the comments ;TYPE, ;Z, ;HEIGHT.
/// \throws InvalidInput  no line is printed, one ends over 10 m away, or all are over 20 km long.
SlicedPrint read_gcode(std::string_view text, std::string_view source);

}  // namespace fretwork
