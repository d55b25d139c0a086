// Percentiles by nearest rank.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace fretwork {

/// Where, in ascending order of `count` values (at least one), the one stands that `share` of them do not exceed.
[[nodiscard]] inline std::size_t nearest_rank(std::size_t count, double share) {
    const auto rank = static_cast<std::size_t>(std::ceil(share * static_cast<double>(count)));
    return std::max<std::size_t>(rank, 1) - 1;
}

}  // namespace fretwork
