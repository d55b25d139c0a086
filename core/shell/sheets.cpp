#include "core/shell/sheets.h"

#include <algorithm>

#include "core/shell/triangle_cells.h"

namespace fretwork {

std::uint32_t SheetSplitter::root(std::uint32_t user) {
    while (parent_[user] != user) {
        parent_[user] = parent_[parent_[user]];
        user = parent_[user];
    }
    return user;
}

const std::vector<std::uint32_t>& SheetSplitter::split(std::span<const std::uint32_t> in_cell, const Vec3& center) {
    const auto count = static_cast<std::uint32_t>(in_cell.size());
    parent_.resize(count);
    for (std::uint32_t i = 0; i < count; ++i) parent_[i] = i;
    sheets_ = count;
    if (count > 1) join_over_shared_edges(in_cell, center);
    number_sheets();
    return sheet_;
}

void SheetSplitter::join_over_shared_edges(std::span<const std::uint32_t> in_cell, const Vec3& center) {
    uses_.clear();
    for (std::uint32_t user = 0; user < in_cell.size(); ++user) {
        const Triangle& t = triangles_[in_cell[user]];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(t[k], t[k == 2 ? 0 : k + 1]);
            uses_.push_back({std::uint64_t{low} << 32 | high, user});
        }
    }
    std::sort(uses_.begin(), uses_.end());
    for (std::size_t i = 1; i < uses_.size() && sheets_ > 1; ++i) {
        if (uses_[i].edge != uses_[i - 1].edge) continue;
        const std::uint32_t a = root(uses_[i - 1].user);
        const std::uint32_t b = root(uses_[i].user);
        if (a == b) continue;
        const Vec3& from = grid_points_[uses_[i].edge >> 32];
        const Vec3& to = grid_points_[uses_[i].edge & 0xffffffffu];
        if (!segment_meets_cell(from, to, center)) continue;
        parent_[std::max(a, b)] = std::min(a, b);
        --sheets_;
    }
}

void SheetSplitter::number_sheets() {
    sheet_.resize(parent_.size());
    std::uint32_t next = 0;
    // A root is the lowest of its sheet, so it has its number before the others ask for it.
    for (std::uint32_t i = 0; i < parent_.size(); ++i) {
        const std::uint32_t r = root(i);
        sheet_[i] = r == i ? next++ : sheet_[r];
    }
}

}  // namespace fretwork
