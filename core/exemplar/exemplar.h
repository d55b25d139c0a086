// Input of the synthesis: picture -> colours, solid mask and feature distance.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/exemplar/image.h"

namespace fretwork {

/// Where the solid mask comes from.
enum class MaskSource {
    kAutomatic,  ///< the alpha channel if it varies, else an Otsu cut on luma: dark is solid
    kAlpha,      ///< opaque is solid
    kThreshold,  ///< luma below `threshold` is solid
    kImage,      ///< the separate mask picture: light is solid
};

struct ExemplarSettings {
    MaskSource mask = MaskSource::kAutomatic;
    double threshold = 0.5;  ///< luma in [0, 1]
    bool invert = false;     ///< exchange solid and empty
    /// Whether the picture continues across its borders. Empty: decided from the step across them.
    std::optional<bool> tileable = std::nullopt;
    int max_side_px = 1024;  ///< larger pictures are reduced first
};

/// I: (x, y) -> (r, g, b, f) of the paper, section 3, on a pixel grid; row 0 on top.
struct Exemplar {
    int width = 0;
    int height = 0;
    bool tileable = false;
    std::vector<Rgb8> color;
    std::vector<std::uint8_t> solid;  ///< s: 1 solid, 0 empty
    /// Signed distance to the border between solid and empty, in pixels, negative in solid; measured
    /// with wrap-around when tileable.
    std::vector<float> feature_distance_px;

    [[nodiscard]] double solid_fraction() const;
};

/// \param mask  used with MaskSource::kImage only; scaled to the picture if its size differs.
/// \throws InvalidInput  a picture under 4 px, a mask that is all solid or all empty, MaskSource::kAlpha
///                       without transparency, MaskSource::kImage without a mask.
/// \throws InvalidSetting  threshold outside [0, 1].
Exemplar make_exemplar(const Image& picture, const Image* mask = nullptr, const ExemplarSettings& settings = {});

}  // namespace fretwork
