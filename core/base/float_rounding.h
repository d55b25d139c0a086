// Coordinates as single precision keeps them.
#pragma once

#include "core/base/vec.h"

namespace fretwork {

/// Each component rounded to the nearest float, held as a double. The volatile step is needed: g++ 12 at -O3 pairs
/// the components of `p.cast<float>().cast<double>()` up and drops the conversion to float and back.
[[nodiscard]] inline Vec3 rounded_to_float(const Vec3& p) {
    Vec3 result;
    for (int k = 0; k < 3; ++k) {
        const volatile float component = static_cast<float>(p[k]);
        result[k] = static_cast<double>(component);
    }
    return result;
}

}  // namespace fretwork
