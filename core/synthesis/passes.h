// How often a level is visited.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/synthesis/synthesizer.h"

namespace fretwork {

/// Passes belong to the coarse levels, where they are cheap and decide the layout.
/// \param rank  of the level (ProblemLevel)
[[nodiscard]] inline int passes_on_level(const SynthesisSettings& settings, int rank) {
    return std::min(settings.coarse_passes, 1 << std::min(rank, 16));
}

/// Least passes of a local update, which has to grow in from its surroundings: with few of them the inside of a bridge
/// is left as confetti.
inline constexpr int kLocalPasses = 8;

/// A number for each pass of each level of each call.
/// \param height  of the level (ProblemLevel)
[[nodiscard]] inline std::uint32_t epoch_of(int height, int pass, std::uint32_t call) {
    return call << 12 | static_cast<std::uint32_t>(height) << 8 | static_cast<std::uint32_t>(pass);
}

}  // namespace fretwork
