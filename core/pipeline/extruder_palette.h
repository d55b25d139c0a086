// Colours of triangles -> the few that a printer's extruders can hold.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/exemplar/image.h"

namespace fretwork {

/// The colours that stand best for all: k-means in CIE Lab, started from the most used colour and then from those that
/// are farthest from the ones taken, by use. The colour that stands for most comes first.
///
/// The same arguments give the same colours; there is no chance in it.
/// Cost  about a second for 10 M colours.
/// \param weights    of each colour, not negative: areas
/// \param extruders  1 to 16; fewer colours than that give a smaller palette
/// \throws InvalidInput  other numbers of colours and weights; no colour
std::vector<Rgb8> extruder_palette(std::span<const Rgb8> colors, std::span<const double> weights, int extruders);

/// The extruder, from 1, whose colour is nearest in Lab; the lowest of several.
std::vector<std::uint8_t> extruders_of(std::span<const Rgb8> colors, std::span<const Rgb8> palette);

}  // namespace fretwork
