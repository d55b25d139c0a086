// One drawing function per built-in pattern; the table in builtin_patterns.cpp lists them.
#pragma once

#include "core/exemplar/builtin/builtin_patterns.h"

namespace fretwork::drawing {

PatternPictures draw_animalskin();
PatternPictures draw_branches();
PatternPictures draw_bricks();
PatternPictures draw_bubbles();
PatternPictures draw_cells();
PatternPictures draw_celtic();
PatternPictures draw_coral();
PatternPictures draw_dots();
PatternPictures draw_girih();
PatternPictures draw_hexagons();
PatternPictures draw_hooks();
PatternPictures draw_keyboard();
PatternPictures draw_lace();
PatternPictures draw_leafveins();
PatternPictures draw_scales();
PatternPictures draw_spirals();
PatternPictures draw_waves();
PatternPictures draw_zebra();

}  // namespace fretwork::drawing
