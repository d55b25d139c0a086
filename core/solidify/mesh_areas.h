// Which part of a picture each triangle shows.
#pragma once

#include <cstdint>
#include <vector>

namespace fretwork {

/// Areas of triangles whose borders simplifying keeps.
struct MeshAreas {
    static constexpr std::uint8_t kBorder = 255;

    std::vector<std::uint8_t> of_triangle;
    std::vector<std::uint8_t> of_vertex;  ///< the area around it; kBorder: it was put on a border between areas
};

}  // namespace fretwork
