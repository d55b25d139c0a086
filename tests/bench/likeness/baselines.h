// Flat outputs of known worth, on whose scale our own are read: crop < good 2D synthesis < patch tiling < noise.
#pragma once

#include <cstdint>
#include <vector>

#include "likeness/pattern_picture.h"

namespace fretwork::likeness {

/// Which pixel of an exemplar each pixel of an output shows.
struct SourceMap {
    int width = 0;
    int height = 0;
    std::vector<std::array<int, 2>> source;

    [[nodiscard]] const std::array<int, 2>& at(int x, int y) const {
        return source[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
    }
};

/// The exemplar from a random place on; no larger than the exemplar where that does not wrap.
SourceMap crop_map(const PatternPicture& exemplar, int side, std::uint64_t seed);

/// What a careful pixel-based synthesizer on a plane reaches: coarse to fine, each pixel takes, of the continuations of
/// its 24 neighbours' pieces, of pixels that resemble them and of random ones, the place whose 7 x 7 window matches
/// best (after Lefebvre and Hoppe 2005). Every pixel is copied, none is blended. About a second for 160 x 160.
SourceMap synthesized_map(const PatternPicture& exemplar, int side, std::uint64_t seed);

/// Square blocks of a quarter of the exemplar's width from random places, side by side.
SourceMap tiled_map(const PatternPicture& exemplar, int side, std::uint64_t seed);

/// Every pixel from a random place.
SourceMap noise_map(const PatternPicture& exemplar, int side, std::uint64_t seed);

/// The picture of a map, read between the pixels as voxels do: all maps with one random shift below a pixel.
PatternPicture picture_of(const SourceMap& map, const PatternPicture& exemplar, std::uint64_t seed);

}  // namespace fretwork::likeness
