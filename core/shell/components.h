// Connected components of the shell, whole or restricted to one state.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

inline constexpr std::uint32_t kNoComponent = 0xffffffffu;

struct ShellComponents {
    std::vector<std::uint32_t> of;   ///< component of each entry; kNoComponent where left out
    std::vector<std::size_t> sizes;  ///< entries per component

    [[nodiscard]] std::size_t count() const { return sizes.size(); }
};

/// Components over all links, numbered by their lowest entry. Linear.
[[nodiscard]] ShellComponents connected_components(const Adjacency& adjacency);

/// Components among the entries with `states[v] == state`, over links between two of them. Both arguments have one
/// entry per voxel.
[[nodiscard]] ShellComponents connected_components(const Adjacency& adjacency, const SolidStates& states,
                                                   SolidState state);

/// Do the cells of two entries share a face? (Links also run over edges and corners, length sqrt 2, sqrt 3.)
[[nodiscard]] bool share_face(const VoxelCoord& a, const VoxelCoord& b);

/// Links of `adjacency` between cells that share a face.
[[nodiscard]] Adjacency face_links(const Adjacency& adjacency);

}  // namespace fretwork
