// Inside of the pyramid: who belongs to N(v).
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "core/base/run_control.h"
#include "core/pyramid/ways.h"
#include "core/shell/cell_rows.h"

namespace fretwork {

/// A neighbour to which no smooth way leads carries this mark, in the top bit of its index.
inline constexpr std::uint32_t kCreased = 0x80000000u;

/// N(v) for the entries of a level. Around most entries a cell tells the entry, and sets of cells, combined by shifts,
/// tell N(v) at once; where cells hold several entries, links are followed.
class NeighborLists {
  public:
    /// `level` and `ways` must outlive this. Counts all lists. \throws Cancelled
    NeighborLists(const PyramidLevel& level, const Ways& ways, const RunControl& run);

    /// |N(v)|
    [[nodiscard]] std::uint32_t count(VoxelIndex v) const { return count_[v]; }

    /// Calls `visit(v, list)` for v in [begin, end), ascending. The list holds N(v), ascending and marked; it is gone
    /// after the call. Safe to be called for several ranges at once.
    using Visit = std::function<void(VoxelIndex, std::span<const std::uint32_t>)>;
    void list(std::size_t begin, std::size_t end, const Visit& visit) const;

  private:
    /// The cells of the 5x5x5 cube around an entry, bit (x + 2) + 5 (y + 2) + 25 (z + 2).
    struct Cube {
        std::uint64_t low = 0, high = 0;

        /// \param bit  of the lowest cell of `touching`
        void add(std::uint64_t touching, int bit) {
            low |= touching << bit;
            high |= (touching >> 1) >> (63 - bit);
        }
    };
    /// Cells that an entry is linked to, and its own, as a part of its cube.
    struct Touching {
        std::uint64_t cells = 0;
        std::uint64_t smooth = 0;  ///< over steps with at least kSmoothCosine
    };
    /// N(v) where cells tell entries, v itself included.
    struct Reached {
        Cube cells;
        Cube smooth;
    };
    class RowCursors;

    [[nodiscard]] Touching survey(VoxelIndex v) const;
    [[nodiscard]] bool reach(VoxelIndex v, Reached& reached) const;
    void count(std::size_t begin, std::size_t end);

    const PyramidLevel& level_;
    const Ways& ways_;
    CellRows rows_;
    std::vector<VoxelIndex> layers_;
    BulkVector<Touching> touching_;
    BulkVector<Reached> reached_;
    std::vector<std::uint8_t> crowded_;  ///< links must be followed
    std::vector<std::uint32_t> count_;
};

}  // namespace fretwork
