// Lengths that describe a black-and-white pattern, and how far two lists of them are apart.
#pragma once

#include <cstdint>
#include <vector>

#include "likeness/pattern_picture.h"

namespace fretwork::likeness {

/// Where the solid channel is at least a half.
std::vector<std::uint8_t> solid_mask(const PatternPicture& picture);

/// Lengths, in pixels, of the straight runs of one phase along rows (direction 0), columns (1) and both diagonals
/// (2, 3). Runs that touch the border are dropped; in a picture that wraps they go on across it.
std::vector<double> chord_lengths(const PatternPicture& picture, bool solid, int direction);

/// Distance of every pixel of one phase to the nearest of the other, in pixels; empty if there is none.
std::vector<double> thicknesses(const PatternPicture& picture, bool solid);

/// Earth mover's distance between two lists taken as distributions.
/// \throws InvalidInput  an empty list.
double wasserstein(std::vector<double> a, std::vector<double> b);

/// `wasserstein` over the mean of `reference`; 1 where the output has no length at all and the reference has.
double relative_wasserstein(const std::vector<double>& output, const std::vector<double>& reference);

}  // namespace fretwork::likeness
