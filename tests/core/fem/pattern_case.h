// A pattern on a body, and its abstract graph.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "core/graph/connect_samples.h"
#include "core/graph/poisson_disk.h"
#include "core/shell/components.h"
#include "core/shell/voxelize.h"
#include "support/carved_shells.h"

namespace fretwork::testing {

struct Case {
    SurfaceVoxels shell;
    SolidStates solid;
    AbstractGraph graph;
};

inline Case make_case(const TriangleMesh& mesh, int resolution, const SolidStates* states, std::size_t samples) {
    Case c;
    c.shell = voxelize(mesh, {.resolution = resolution});
    c.solid = states != nullptr ? *states : SolidStates(c.shell.size(), SolidState::kSolid);
    SampleSettings sampling;
    sampling.target = samples;
    sampling.least = 1;
    std::vector<VoxelIndex> chosen =
        poisson_samples(c.shell.adjacency, connected_components(c.shell.adjacency), c.solid, sampling).voxels;
    c.graph = connect_samples(c.shell.adjacency, c.solid, std::move(chosen), ExtendFrom::kTree);
    return c;
}

inline Case blob_case(const TriangleMesh& mesh, int resolution, std::uint64_t seed, std::size_t samples) {
    const SolidStates states = blobs(voxelize(mesh, {.resolution = resolution}), 12.0, seed);
    return make_case(mesh, resolution, &states, samples);
}

inline std::vector<EdgeState> states_of(const AbstractGraph& graph) {
    std::vector<EdgeState> states;
    for (const AbstractEdge& edge : graph.edges) states.push_back(edge.state);
    return states;
}

}  // namespace fretwork::testing
