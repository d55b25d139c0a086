// The patterns that come with Fretwork, drawn by code.
#pragma once

#include <span>
#include <string_view>

#include "core/exemplar/exemplar.h"
#include "core/exemplar/image.h"

namespace fretwork {

/// What a user needs to know to choose a pattern, and what a run takes from it by default.
struct BuiltinPattern {
    std::string_view name;
    std::string_view description;  ///< one line, no full stop
    bool tileable;                 ///< the picture continues across its borders
    bool anisotropic;              ///< has a direction; needs an orientation field to look right
    bool connected;                ///< the solid phase is one piece on the torus
    double width_mm;               ///< natural width of the picture on the surface
    double pattern_radius_px;      ///< half a typical stroke: r_pattern for reinforcement bridges
};

/// In the order in which they are listed to users.
[[nodiscard]] std::span<const BuiltinPattern> builtin_patterns();

/// \throws InvalidSetting  unknown name; the message lists the known ones.
[[nodiscard]] const BuiltinPattern& find_builtin(std::string_view name);

/// Colours and mask (light is solid) of one pattern, of equal size, 128 to 256 px per side.
struct PatternPictures {
    Image color;
    Image mask;
};

/// Draws a pattern; the same pixels on every call and for any number of threads. Takes up to half a second of
/// CPU.
/// \throws InvalidSetting  unknown name
[[nodiscard]] PatternPictures draw_builtin(std::string_view name);

/// The exemplar of `draw_builtin`, tileable, with the antialiased mask behind its feature distance.
/// \throws InvalidSetting  unknown name
[[nodiscard]] Exemplar make_builtin(std::string_view name);

}  // namespace fretwork
