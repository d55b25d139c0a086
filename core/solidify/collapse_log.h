// The collapses of a mesh in the order they were done, to take some of them back.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/solidify/simplify_state.h"

namespace fretwork {

/// A collapse can be taken back once all later ones that changed a triangle it changed have been; which these are is
/// known from a list of collapses per triangle. The lists are made when first needed.
class CollapseLog {
  public:
    using Corner = CollapseMesh::Corner;

    explicit CollapseLog(SimplifyState& state) : state_(state) {}

    /// Appends what BlockSimplifier wrote.
    void append(std::vector<Corner> entries);

    /// Takes back the last `count` collapses that changed each of the triangles, with what depends on them, and locks
    /// the vertices that come back. The triangles may be dead by the time their turn comes.
    /// \return the triangles that changed and are alive, ascending
    std::vector<std::uint32_t> take_back(std::span<const std::uint32_t> triangles, int count);

  private:
    template <class Visit>
    void for_each_touched(std::uint32_t place, const Visit& visit) const;
    void list_by_triangle();
    void take_back(std::uint32_t place);
    void undo(std::uint32_t place);
    void file_again(std::uint32_t u, const std::vector<std::uint32_t>& fan);

    static constexpr std::uint32_t kNone = CollapseMesh::kNone;

    SimplifyState& state_;
    std::vector<Corner> entries_;       ///< edge, how many stayed, those
    std::vector<std::uint32_t> first_;  ///< per triangle: its collapses begin here in by_triangle_
    std::vector<std::uint32_t> end_;    ///< per triangle: those not taken back end here
    std::vector<std::uint32_t> by_triangle_;
    std::vector<std::uint32_t> changed_;
};

}  // namespace fretwork
