// Pictures for the tests of the measures.
#pragma once

#include <cmath>

#include "core/exemplar/builtin/builtin_patterns.h"
#include "likeness/pattern_picture.h"

namespace fretwork::likeness {

/// A built-in pattern at the given width. It tiles.
inline PatternPicture builtin_picture(std::string_view name, int width) {
    return picture_of(make_builtin(name), width);
}

inline PatternPicture cells_picture(int width) {
    return builtin_picture("cells", width);
}

/// Upright stripes: `solid` columns solid, then `empty` ones empty, from a solid one on.
inline PatternPicture stripes_picture(int width, int height, int solid, int empty, bool wraps) {
    PatternPicture picture{width, height, wraps, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const float value = x % (solid + empty) < solid ? 1.0F : 0.0F;
            picture.pixels.push_back({value, value, value, value});
        }
    return picture;
}

}  // namespace fretwork::likeness
