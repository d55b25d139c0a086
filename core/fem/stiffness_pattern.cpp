#include "core/fem/stiffness_pattern.h"

#include <algorithm>
#include <utility>

namespace fretwork {
namespace {

constexpr std::uint32_t kNoPair = 0xffffffffu;

}  // namespace

void ElementNodes::add(std::span<const NodeIndex> nodes) {
    node.insert(node.end(), nodes.begin(), nodes.end());
    first.push_back(static_cast<std::uint32_t>(node.size()));
}

StiffnessPattern::StiffnessPattern(const ElementNodes& elements, std::vector<std::uint8_t> fixed)
    : elements_(elements) {
    dof_.assign(fixed.size(), kFixed);
    std::int64_t next = 0;
    for (std::size_t n = 0; n < fixed.size(); ++n) {
        if (fixed[n] != 0) continue;
        dof_[n] = next;
        next += 3;
    }
    block_first_.assign(static_cast<std::size_t>(next / 3) + 1, 0);
    find_blocks(elements);
    expand_blocks();
    locate_pairs(elements);
}

void StiffnessPattern::find_blocks(const ElementNodes& elements) {
    std::vector<std::pair<std::int64_t, std::int64_t>> blocks;  // (column, row) of nodes, row >= column
    for (std::size_t e = 0; e < elements.size(); ++e)
        for (const NodeIndex p : elements.of(e))
            for (const NodeIndex q : elements.of(e))
                if (dof_[p] != kFixed && dof_[q] != kFixed && dof_[q] <= dof_[p])
                    blocks.emplace_back(dof_[q] / 3, dof_[p] / 3);
    // A free node without an element still has a row; its zero diagonal is found when factoring.
    for (std::size_t n = 0; n + 1 < block_first_.size(); ++n)
        blocks.emplace_back(static_cast<std::int64_t>(n), static_cast<std::int64_t>(n));
    std::ranges::sort(blocks);
    blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
    block_row_.reserve(blocks.size());
    for (const auto& [column, row] : blocks) {
        ++block_first_[static_cast<std::size_t>(column) + 1];
        block_row_.push_back(row);
    }
    for (std::size_t n = 1; n < block_first_.size(); ++n) block_first_[n] += block_first_[n - 1];
}

void StiffnessPattern::expand_blocks() {
    column_first_.reserve(rows() + 1);
    column_first_.push_back(0);
    row_.reserve(block_row_.size() * 9);
    for (std::size_t n = 0; n < free_nodes(); ++n) {
        for (std::int64_t c = 0; c < 3; ++c) {
            for (std::int64_t b = block_first_[n]; b < block_first_[n + 1]; ++b) {
                const std::int64_t row = 3 * block_row_[static_cast<std::size_t>(b)];
                // The first block of a column is the diagonal one, of which the lower triangle is kept.
                for (std::int64_t r = b == block_first_[n] ? c : 0; r < 3; ++r) row_.push_back(row + r);
            }
            column_first_.push_back(static_cast<std::int64_t>(row_.size()));
        }
    }
}

void StiffnessPattern::locate_pairs(const ElementNodes& elements) {
    first_pair_.reserve(elements.size());
    for (std::size_t e = 0; e < elements.size(); ++e) {
        first_pair_.push_back(static_cast<std::uint32_t>(pair_rank_.size()));
        for (const NodeIndex p : elements.of(e)) {
            for (const NodeIndex q : elements.of(e)) {
                if (dof_[p] == kFixed || dof_[q] == kFixed || dof_[q] > dof_[p]) {
                    pair_rank_.push_back(kNoPair);
                    continue;
                }
                const auto column = static_cast<std::size_t>(dof_[q] / 3);
                const auto begin = block_row_.begin() + block_first_[column];
                const auto end = block_row_.begin() + block_first_[column + 1];
                pair_rank_.push_back(static_cast<std::uint32_t>(std::lower_bound(begin, end, dof_[p] / 3) - begin));
            }
        }
    }
}

void StiffnessPattern::add_element(std::size_t element, double factor, const double* matrix,
                                   std::span<double> values) const {
    const std::span<const NodeIndex> nodes = elements_.of(element);
    const std::size_t size = 3 * nodes.size();
    const std::uint32_t* rank = pair_rank_.data() + first_pair_[element];
    for (std::size_t p = 0; p < nodes.size(); ++p) {
        for (std::size_t q = 0; q < nodes.size(); ++q, ++rank) {
            if (*rank == kNoPair) continue;
            const auto column = static_cast<std::size_t>(dof_[nodes[q]]);
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t lowest = *rank == 0 ? c : 0;
                const std::size_t start = static_cast<std::size_t>(column_first_[column + c]) +
                                          (*rank == 0 ? 0 : 3 - c + 3 * (std::size_t{*rank} - 1));
                for (std::size_t r = lowest; r < 3; ++r)
                    values[start + r - lowest] += factor * matrix[(3 * p + r) * size + 3 * q + c];
            }
        }
    }
}

}  // namespace fretwork
