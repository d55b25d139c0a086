#include "core/shell/cell_rows.h"

#include <algorithm>
#include <cstdlib>

#include "core/base/parallel.h"

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
    x_.resize(coords.size());
    shares_cell_.resize(coords.size());
    if (coords.empty()) return;
    // The first entry of a row starts it, and the empty rows before it.
    parallel_for(coords.size(), 8192, [&](std::size_t v) {
        x_[v] = static_cast<std::int16_t>(coords[v][0]);
        shares_cell_[v] = (v > 0 && same_cell(coords[v - 1], coords[v])) ||
                          (v + 1 < coords.size() && same_cell(coords[v + 1], coords[v]));
        const std::size_t row = row_of(coords[v]);
        for (std::size_t r = row; v > 0 && r > row_of(coords[v - 1]); --r)
            row_first_[r] = static_cast<std::uint32_t>(v);
    });
    for (std::size_t r = row_of(coords.back()) + 1; r <= rows; ++r)
        row_first_[r] = static_cast<std::uint32_t>(coords.size());
}

std::size_t CellRows::place_cursors(const VoxelCoord& c, std::span<Cursor> cursors) const {
    std::size_t used = 0;
    for (int dz = -1; dz <= 1; ++dz)
        for (int dy = -1; dy <= 1; ++dy) {
            const Row r = row(c[1] + dy, c[2] + dz);
            if (r.begin != r.end) cursors[used++] = {r.begin, r.end, 1 + 3 * (dy + 1) + 9 * (dz + 1)};
        }
    return used;
}

CellSetOverlap::CellSetOverlap() {
    for (int z = -2; z <= 2; ++z)
        for (int y = -2; y <= 2; ++y)
            for (int x = -2; x <= 2; ++x) {
                const int code = (x + 2) + 5 * (y + 2) + 25 * (z + 2);
                Shift& s = shifts_[static_cast<std::size_t>(code)];
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
