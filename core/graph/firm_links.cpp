#include "core/graph/firm_links.h"

namespace fretwork {

Adjacency firm_links(const Adjacency& graph) {
    Adjacency result;
    if (graph.first.empty()) return result;
    const ShellComponents by_face = connected_components(face_links(graph));
    const std::size_t n = graph.first.size() - 1;
    result.first.reserve(n + 1);
    result.first.push_back(0);
    for (VoxelIndex v = 0; v < n; ++v) {
        for (std::uint32_t e = graph.first[v]; e < graph.first[v + 1]; ++e) {
            const VoxelIndex w = graph.neighbor[e];
            // Links measure 1 over a face, sqrt 2 over an edge, sqrt 3 over a corner.
            if (graph.length_voxels[e] > 1.2f && by_face.of[v] == by_face.of[w]) continue;
            result.neighbor.push_back(w);
            result.length_voxels.push_back(graph.length_voxels[e]);
        }
        result.first.push_back(static_cast<std::uint32_t>(result.neighbor.size()));
    }
    return result;
}

}  // namespace fretwork
