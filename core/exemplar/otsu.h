// Automatic threshold between dark and light.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

namespace fretwork {

using Histogram = std::array<std::uint64_t, 256>;

/// The cut that separates a histogram into two classes with the largest variance between them
/// \cite otsu1979threshold. Values below the cut form the dark class.
///
/// Where several cuts are equally good (an empty stretch between two peaks) the middle one is taken.
/// \returns a multiple of 1/2 in (0, 255) that is no value of the histogram; nothing if fewer than two values occur
std::optional<double> otsu_threshold(const Histogram& histogram);

}  // namespace fretwork
