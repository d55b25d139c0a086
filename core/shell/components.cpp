#include "core/shell/components.h"

#include <cstdlib>

namespace fretwork {
namespace {

template <class Included>
ShellComponents flood(const Adjacency& adjacency, const Included& included) {
    const std::size_t count = adjacency.first.empty() ? 0 : adjacency.first.size() - 1;
    ShellComponents result;
    result.of.assign(count, kNoComponent);
    std::vector<VoxelIndex> open;
    for (VoxelIndex seed = 0; seed < count; ++seed) {
        if (result.of[seed] != kNoComponent || !included(seed)) continue;
        const auto id = static_cast<std::uint32_t>(result.sizes.size());
        std::size_t size = 0;
        result.of[seed] = id;
        open.push_back(seed);
        while (!open.empty()) {
            const VoxelIndex v = open.back();
            open.pop_back();
            ++size;
            for (const VoxelIndex w : adjacency.of(v)) {
                if (result.of[w] != kNoComponent || !included(w)) continue;
                result.of[w] = id;
                open.push_back(w);
            }
        }
        result.sizes.push_back(size);
    }
    return result;
}

}  // namespace

ShellComponents connected_components(const Adjacency& adjacency) {
    return flood(adjacency, [](VoxelIndex) { return true; });
}

ShellComponents connected_components(const Adjacency& adjacency, const SolidStates& states, SolidState state) {
    return flood(adjacency, [&](VoxelIndex v) { return states[v] == state; });
}

bool share_face(const VoxelCoord& a, const VoxelCoord& b) {
    return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) == 1;
}

Adjacency face_links(const Adjacency& adjacency) {
    // A link over a face has length 1, the next longer one sqrt 2.
    constexpr float longest = 1.2f;
    Adjacency faces;
    faces.first.reserve(adjacency.first.size());
    for (std::size_t v = 0; v < adjacency.first.size(); ++v) {
        faces.first.push_back(static_cast<std::uint32_t>(faces.neighbor.size()));
        if (v + 1 == adjacency.first.size()) break;
        for (std::uint32_t e = adjacency.first[v]; e < adjacency.first[v + 1]; ++e) {
            if (adjacency.length_voxels[e] > longest) continue;
            faces.neighbor.push_back(adjacency.neighbor[e]);
            faces.length_voxels.push_back(adjacency.length_voxels[e]);
        }
    }
    return faces;
}

}  // namespace fretwork
