// One drawing function per built-in pattern; the table in builtin_patterns.cpp lists them.
#pragma once

#include "core/exemplar/builtin/builtin_patterns.h"

namespace fretwork::drawing {

PatternPictures draw_cells();
PatternPictures draw_waves();
PatternPictures draw_hooks();
PatternPictures draw_zebra();
PatternPictures draw_hexagons();
PatternPictures draw_dots();

}  // namespace fretwork::drawing
