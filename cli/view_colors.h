// Colours that stand for what a surface is, in reports and renders.
#pragma once

#include "core/exemplar/image.h"

namespace fretwork::cli {

inline constexpr Rgb8 kBridge = {214, 84, 32};      ///< made solid for strength
inline constexpr Rgb8 kPlain = {196, 199, 204};     ///< the rest of the object
inline constexpr Rgb8 kNotKnown = {150, 150, 150};  ///< nothing is known here

}  // namespace fretwork::cli
