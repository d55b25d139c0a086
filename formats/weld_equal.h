// Gives corners at exactly the same place one index.
#pragma once

#include <cstdint>
#include <vector>

#include "core/mesh/triangle_mesh.h"

namespace fretwork {

/// Collects triangle corners of formats without shared vertices (STL). Vertices are numbered in order
/// of first use, so the result depends on the file alone.
class EqualPointWelder {
  public:
    explicit EqualPointWelder(std::size_t corners_expected);

    /// Index of the vertex at `p`; minus zero equals zero.
    std::uint32_t index_of(const Vec3& p);

    [[nodiscard]] std::vector<Vec3> take_positions() { return std::move(positions_); }

  private:
    void grow();

    std::vector<Vec3> positions_;
    std::vector<std::uint32_t> slots_;  ///< open addressing; index + 1, 0 is free
};

}  // namespace fretwork
