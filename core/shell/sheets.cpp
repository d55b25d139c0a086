#include "core/shell/sheets.h"

#include <algorithm>

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
    // Comparing all pairs beats sorting as long as there are few.
    constexpr std::uint32_t kFew = 8;
    if (count > 1 && count <= kFew) join_pairwise(in_cell, center);
    if (count > kFew) join_by_sorting_edges(in_cell, center);
    number_sheets();
    return sheet_;
}

void SheetSplitter::join_over_edge(std::uint32_t a, std::uint32_t b, std::uint32_t from, std::uint32_t to,
                                   const Vec3& center) {
    a = root(a);
    b = root(b);
    // What degenerate triangles share as an edge may be a single point; that joins nothing.
    if (a == b || from == to || !segment_meets_cell(mesh_.points[from], mesh_.points[to], center)) return;
    parent_[std::max(a, b)] = std::min(a, b);
    --sheets_;
}

void SheetSplitter::join_pairwise(std::span<const std::uint32_t> in_cell, const Vec3& center) {
    for (std::uint32_t j = 1; j < in_cell.size(); ++j)
        for (std::uint32_t i = 0; i < j && sheets_ > 1; ++i) {
            const Triangle& s = mesh_.triangles[in_cell[i]];
            const Triangle& t = mesh_.triangles[in_cell[j]];
            bool in_t[3];
            for (std::size_t k = 0; k < 3; ++k) in_t[k] = s[k] == t[0] || s[k] == t[1] || s[k] == t[2];
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t next = k == 2 ? 0 : k + 1;
                if (in_t[k] && in_t[next]) join_over_edge(i, j, s[k], s[next], center);
            }
        }
}

void SheetSplitter::join_by_sorting_edges(std::span<const std::uint32_t> in_cell, const Vec3& center) {
    uses_.clear();
    for (std::uint32_t user = 0; user < in_cell.size(); ++user) {
        const Triangle& t = mesh_.triangles[in_cell[user]];
        for (std::size_t k = 0; k < 3; ++k) {
            const auto [low, high] = std::minmax(t[k], t[k == 2 ? 0 : k + 1]);
            uses_.push_back({std::uint64_t{low} << 32 | high, user});
        }
    }
    std::sort(uses_.begin(), uses_.end());
    for (std::size_t i = 1; i < uses_.size() && sheets_ > 1; ++i)
        if (uses_[i].edge == uses_[i - 1].edge)
            join_over_edge(uses_[i - 1].user, uses_[i].user, static_cast<std::uint32_t>(uses_[i].edge >> 32),
                           static_cast<std::uint32_t>(uses_[i].edge), center);
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
