// How Kuhn's subdivision numbers the edges, triangles and tetrahedra of a cubic lattice.
#pragma once

#include <array>
#include <cstdint>

namespace fretwork::kuhn {

/// A corner of the unit cell is a mask of the axes on which it lies at 1. Each simplex is a chain of growing masks; it
/// belongs to its lowest corner. Edges: masks 1..7. Triangles: pairs (middle, top) with middle inside top.
using Mask = std::uint8_t;

struct TriangleType {
    Mask middle, top;
};
inline constexpr std::array<TriangleType, 12> kTriangles = {
    {{1, 3}, {1, 5}, {1, 7}, {2, 3}, {2, 6}, {2, 7}, {4, 5}, {4, 6}, {4, 7}, {3, 7}, {5, 7}, {6, 7}}};

/// Index into kTriangles of a chain 0 < middle < top.
constexpr unsigned triangle_type(Mask middle, Mask top) {
    for (unsigned t = 0; t < kTriangles.size(); ++t)
        if (kTriangles[t].middle == middle && kTriangles[t].top == top) return t;
    return 12;
}

/// Corners of the six tetrahedra, lowest first, and whether they are positively oriented in that order.
struct Tetrahedron {
    std::array<Mask, 4> corner;
    bool positive;
};
inline constexpr std::array<Tetrahedron, 6> kTetrahedra = {{{{0, 1, 3, 7}, true},
                                                            {{0, 2, 6, 7}, true},
                                                            {{0, 4, 5, 7}, true},
                                                            {{0, 2, 3, 7}, false},
                                                            {{0, 1, 5, 7}, false},
                                                            {{0, 4, 6, 7}, false}}};

}  // namespace fretwork::kuhn
