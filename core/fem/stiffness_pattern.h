// Stage 5b: where element matrices go in the global one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fretwork {

using NodeIndex = std::uint32_t;

/// Elements as lists of nodes, in compressed rows.
struct ElementNodes {
    std::vector<std::uint32_t> first{0};
    std::vector<NodeIndex> node;

    [[nodiscard]] std::size_t size() const { return first.size() - 1; }
    [[nodiscard]] std::span<const NodeIndex> of(std::size_t e) const {
        return {node.data() + first[e], node.data() + first[e + 1]};
    }
    void add(std::span<const NodeIndex> nodes);
};

/// Lower triangle of K over the free nodes, compressed columns with 64-bit indices; three degrees of
/// freedom per free node, x y z. Fixed nodes have no rows.
class StiffnessPattern {
  public:
    static constexpr std::int64_t kFixed = -1;

    /// \param fixed  one byte per node, nonzero for those that cannot move
    StiffnessPattern(const ElementNodes& elements, std::vector<std::uint8_t> fixed);

    [[nodiscard]] std::size_t free_nodes() const { return block_first_.size() - 1; }
    [[nodiscard]] std::size_t rows() const { return 3 * free_nodes(); }
    [[nodiscard]] std::size_t entries() const { return row_.size(); }

    /// First of the three degrees of freedom of a node, or kFixed.
    [[nodiscard]] std::int64_t dof(NodeIndex node) const { return dof_[node]; }

    /// Adds factor * matrix to `values`; `matrix` is the element's, symmetric, 3 x nodes squared, dense.
    void add_element(std::size_t element, double factor, const double* matrix, std::span<double> values) const;

    /// Node graph, lower triangle with diagonal: compressed columns.
    [[nodiscard]] const std::vector<std::int64_t>& block_first() const { return block_first_; }
    [[nodiscard]] const std::vector<std::int64_t>& block_row() const { return block_row_; }
    /// The matrix itself: compressed columns.
    [[nodiscard]] const std::vector<std::int64_t>& column_first() const { return column_first_; }
    [[nodiscard]] const std::vector<std::int64_t>& row() const { return row_; }

  private:
    void find_blocks(const ElementNodes& elements);
    void expand_blocks();
    void locate_pairs(const ElementNodes& elements);

    std::vector<std::int64_t> dof_;
    std::vector<std::int64_t> block_first_, block_row_;
    std::vector<std::int64_t> column_first_, row_;
    ElementNodes elements_;
    std::vector<std::uint32_t> first_pair_;  ///< per element, into pair_rank_
    std::vector<std::uint32_t> pair_rank_;   ///< place of the block within its column, per pair of nodes (p, q)
};

}  // namespace fretwork
