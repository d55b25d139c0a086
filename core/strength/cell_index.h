// Which cells of a lattice are taken, and the how-manieth each is. Internal to this folder and its tests.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

/// One bit per cell and a running count per 64 cells: 1.5 bits a cell, found in constant time.
class CellIndex {
  public:
    static constexpr std::uint32_t kNone = 0xffffffffu;

    explicit CellIndex(const VoxelCoord& extent)
        : extent_(extent),
          row_words_((static_cast<std::size_t>(extent[0]) + 63) / 64),
          words_(row_words_ * static_cast<std::size_t>(extent[1]) * static_cast<std::size_t>(extent[2]), 0) {}

    [[nodiscard]] const VoxelCoord& extent() const { return extent_; }

    [[nodiscard]] bool inside(const VoxelCoord& c) const {
        return c[0] >= 0 && c[1] >= 0 && c[2] >= 0 && c[0] < extent_[0] && c[1] < extent_[1] && c[2] < extent_[2];
    }
    [[nodiscard]] bool taken(const VoxelCoord& c) const {
        return inside(c) && (words_[word_of(c)] >> (static_cast<unsigned>(c[0]) % 64) & 1) != 0;
    }
    /// Rows along x have words of their own: different rows may be filled by different threads.
    void take(const VoxelCoord& c) { words_[word_of(c)] |= std::uint64_t{1} << (static_cast<unsigned>(c[0]) % 64); }

    /// Numbers the taken cells by (z, y, x). Call it after the last `take`.
    void number() {
        before_.resize(words_.size());
        std::uint32_t count = 0;
        for (std::size_t w = 0; w < words_.size(); ++w) {
            before_[w] = count;
            count += static_cast<std::uint32_t>(std::popcount(words_[w]));
        }
        count_ = count;
    }
    [[nodiscard]] std::size_t size() const { return count_; }

    /// Number of a cell, kNone where it is not taken.
    [[nodiscard]] std::uint32_t find(const VoxelCoord& c) const {
        if (!inside(c)) return kNone;
        const std::size_t w = word_of(c);
        const unsigned bit = static_cast<unsigned>(c[0]) % 64;
        if ((words_[w] >> bit & 1) == 0) return kNone;
        const std::uint64_t below = words_[w] & ((std::uint64_t{1} << bit) - 1);
        return before_[w] + static_cast<std::uint32_t>(std::popcount(below));
    }

    /// The taken cells in the order of their numbers.
    [[nodiscard]] std::vector<VoxelCoord> cells() const {
        std::vector<VoxelCoord> cells;
        cells.reserve(count_);
        for (std::size_t w = 0; w < words_.size(); ++w)
            for (std::uint64_t bits = words_[w]; bits != 0; bits &= bits - 1) {
                const std::size_t row = w / row_words_;
                const auto rows = static_cast<std::size_t>(extent_[1]);
                cells.push_back({static_cast<std::int32_t>(w % row_words_ * 64) + std::countr_zero(bits),
                                 static_cast<std::int32_t>(row % rows), static_cast<std::int32_t>(row / rows)});
            }
        return cells;
    }

  private:
    [[nodiscard]] std::size_t word_of(const VoxelCoord& c) const {
        const std::size_t row =
            static_cast<std::size_t>(c[2]) * static_cast<std::size_t>(extent_[1]) + static_cast<std::size_t>(c[1]);
        return row * row_words_ + static_cast<std::size_t>(c[0]) / 64;
    }

    VoxelCoord extent_;
    std::size_t row_words_;
    std::vector<std::uint64_t> words_;
    std::vector<std::uint32_t> before_;
    std::size_t count_ = 0;
};

}  // namespace fretwork
