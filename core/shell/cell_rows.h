// Finds what lies around an entry of a sorted shell without any search tree: by sliding along rows of cells.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

/// The smallest grid that starts at the cell (0, 0, 0) and holds all of `coords`.
[[nodiscard]] VoxelCoord extent_of(std::span<const VoxelCoord> coords);

/// The same as `a == b`, which is compiled to a call.
[[nodiscard]] inline bool same_cell(const VoxelCoord& a, const VoxelCoord& b) {
    return ((a[0] ^ b[0]) | (a[1] ^ b[1]) | (a[2] ^ b[2])) == 0;
}

/// Rows of cells along x of a list sorted by (z, y, x), and where each of them starts.
class CellRows {
  public:
    /// \param extent  cells along x, y, z; every coordinate lies in it
    CellRows(const VoxelCoord& extent, std::span<const VoxelCoord> coords);

    [[nodiscard]] std::size_t size() const { return coords_.size(); }
    [[nodiscard]] const VoxelCoord& extent() const { return extent_; }
    /// The first entry with this z or a larger one.
    [[nodiscard]] VoxelIndex layer_begin(int z) const {
        return row_first_[static_cast<std::size_t>(std::clamp(z, 0, extent_[2])) *
                          static_cast<std::size_t>(extent_[1])];
    }

    /// Calls `visit(v, w, code)` for v ascending in [begin, end) and w ascending over the entries of the cells that
    /// touch that of v. With d = cell of w minus cell of v, code = (d_x + 1) + 3 (d_y + 1) + 9 (d_z + 1).
    /// Cost: nine rows per entry; what lies in a row is passed over once per row of entries.
    template <class Visit>
    void sweep(std::size_t begin, std::size_t end, const Visit& visit) const {
        constexpr int own_cell = 13;
        std::array<Cursor, 9> cursors;
        std::size_t used = 0;
        for (std::size_t v = begin; v < end; ++v) {
            const VoxelCoord& c = coords_[v];
            if (v == begin || c[1] != coords_[v - 1][1] || c[2] != coords_[v - 1][2]) used = place_cursors(c, cursors);
            const int x = c[0];
            for (std::size_t k = 0; k < used; ++k) {
                Cursor& cursor = cursors[k];
                while (cursor.at < cursor.end && x_[cursor.at] < x - 1) ++cursor.at;
                for (std::uint32_t w = cursor.at; w < cursor.end && x_[w] <= x + 1; ++w)
                    if (const int code = cursor.code + x_[w] - x; code != own_cell)
                        visit(static_cast<VoxelIndex>(v), w, code);
            }
        }
    }

    /// The entries in the row of cells with these y and z; none where there is no such row.
    struct Row {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };
    [[nodiscard]] Row row(int y, int z) const {
        if (y < 0 || y >= extent_[1] || z < 0 || z >= extent_[2]) return {};
        const std::size_t r =
            static_cast<std::size_t>(z) * static_cast<std::size_t>(extent_[1]) + static_cast<std::size_t>(y);
        return {row_first_[r], row_first_[r + 1]};
    }
    /// x of the cell of an entry.
    [[nodiscard]] int x_of(VoxelIndex v) const { return x_[v]; }

    /// Is the cell of `v` listed more than once?
    [[nodiscard]] bool shares_cell(VoxelIndex v) const { return shares_cell_[v] != 0; }

  private:
    struct Cursor {
        std::uint32_t at;
        std::uint32_t end;
        int code;  ///< of the cell in this row with the x of v
    };

    [[nodiscard]] std::size_t row_of(const VoxelCoord& c) const {
        return static_cast<std::size_t>(c[2]) * static_cast<std::size_t>(extent_[1]) + static_cast<std::size_t>(c[1]);
    }
    /// Cursors at the start of the rows around `c` that hold anything; returns their number.
    std::size_t place_cursors(const VoxelCoord& c, std::span<Cursor> cursors) const;

    VoxelCoord extent_;
    std::span<const VoxelCoord> coords_;
    std::vector<std::int16_t> x_;
    std::vector<std::uint8_t> shares_cell_;
    std::vector<std::uint32_t> row_first_;
};

/// A set of the 26 cells around a cell, one bit for each by the code of `CellRows::sweep`.
using CellSet = std::uint32_t;

/// Answers whether the cell sets of two cells up to two apart have a cell in common.
class CellSetOverlap {
  public:
    CellSetOverlap();

    /// \param code  of the second cell seen from the first, by `widened_code`
    /// \return the cells of `first` that are also in `second`, as a set around the first cell
    [[nodiscard]] CellSet common(CellSet first, CellSet second, int code) const {
        const Shift& s = shifts_[static_cast<std::size_t>(code)];
        return first & (((second & s.stays) << s.left) >> s.right);
    }

  private:
    struct Shift {
        CellSet stays = 0;  ///< cells around the second that are also around the first
        std::uint8_t left = 0;
        std::uint8_t right = 0;
    };
    std::array<Shift, 125> shifts_;
};

/// Code of a touching cell by `CellRows::sweep`.
[[nodiscard]] inline int touching_code(const VoxelCoord& from, const VoxelCoord& to) {
    return (to[0] - from[0] + 1) + 3 * (to[1] - from[1] + 1) + 9 * (to[2] - from[2] + 1);
}

/// Code of this cell, seen from the other one.
[[nodiscard]] inline int opposite_code(int touching) {
    return 26 - touching;
}

/// The same cell among the 125 up to two away: (d_x + 2) + 5 (d_y + 2) + 25 (d_z + 2).
[[nodiscard]] inline int widened_code(int touching) {
    return (touching % 3 + 1) + 5 * (touching / 3 % 3 + 1) + 25 * (touching / 9 + 1);
}

}  // namespace fretwork
