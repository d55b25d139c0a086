#include "core/shell/cell_rows.h"

#include <algorithm>
#include <cstdlib>

namespace fretwork {

VoxelCoord extent_of(std::span<const VoxelCoord> coords) {
    VoxelCoord extent = {0, 0, 0};
    for (const VoxelCoord& c : coords)
        for (std::size_t k = 0; k < 3; ++k) extent[k] = std::max(extent[k], c[k] + 1);
    return extent;
}

CellRows::CellRows(const VoxelCoord& extent, std::span<const VoxelCoord> coords) : extent_(extent), coords_(coords) {
    const std::size_t rows = static_cast<std::size_t>(extent_[1]) * static_cast<std::size_t>(extent_[2]);
    row_first_.resize(rows + 1, 0);
    x_.reserve(coords.size());
    for (const VoxelCoord& c : coords) {
        ++row_first_[static_cast<std::size_t>(c[2]) * static_cast<std::size_t>(extent_[1]) +
                     static_cast<std::size_t>(c[1]) + 1];
        x_.push_back(static_cast<std::int16_t>(c[0]));
    }
    for (std::size_t r = 0; r < rows; ++r) row_first_[r + 1] += row_first_[r];
}

std::size_t CellRows::place_cursors(const VoxelCoord& c, int reach, std::span<Cursor> cursors) const {
    const int n = 2 * reach + 1;
    std::size_t used = 0;
    for (int dz = -reach; dz <= reach; ++dz) {
        const int z = c[2] + dz;
        if (z < 0 || z >= extent_[2]) continue;
        for (int dy = -reach; dy <= reach; ++dy) {
            const int y = c[1] + dy;
            if (y < 0 || y >= extent_[1]) continue;
            const std::size_t row =
                static_cast<std::size_t>(z) * static_cast<std::size_t>(extent_[1]) + static_cast<std::size_t>(y);
            if (row_first_[row] == row_first_[row + 1]) continue;
            cursors[used++] = {row_first_[row], row_first_[row + 1], reach + n * (dy + reach) + n * n * (dz + reach)};
        }
    }
    return used;
}

CellSetOverlap::CellSetOverlap() {
    for (int z = -2; z <= 2; ++z)
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x) {
                Shift& s = shifts_[static_cast<std::size_t>((x + 2) + 5 * (y + 2) + 25 * (z + 2))];
                const int by = x + 3 * y + 9 * z;
                s.left = static_cast<std::uint8_t>(by > 0 ? by : 0);
                s.right = static_cast<std::uint8_t>(by < 0 ? -by : 0);
                for (int c = -1; c <= 1; ++c)
                    for (int b = -1; b <= 1; ++b)
                        for (int a = -1; a <= 1; ++a)
                            if (std::abs(a + x) <= 1 && std::abs(b + y) <= 1 && std::abs(c + z) <= 1)
                                s.stays |= CellSet{1} << ((a + 1) + 3 * (b + 1) + 9 * (c + 1));
            }
}

}  // namespace fretwork
