#include "core/graph/connect_samples.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/base/parallel.h"
#include "core/graph/tree_crossings.h"

namespace fretwork {
namespace {

void check_samples(const SolidStates& solid, const std::vector<VoxelIndex>& samples) {
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const std::string place =
            "connect_samples: sample " + std::to_string(i) + " is voxel " + std::to_string(samples[i]);
        if (samples[i] >= solid.size())
            throw InvalidInput(place + ", past the end of a shell of " + std::to_string(solid.size()));
        if (solid[samples[i]] != SolidState::kSolid) throw InvalidInput(place + ", which is empty; expected solid");
        if (i > 0 && samples[i - 1] >= samples[i]) throw InvalidInput(place + "; expected ascending order");
    }
}

/// Lengths along the path of edge `e`. A step counts for the gap unless it joins two solid voxels.
void measure_path(const Adjacency& graph, const SolidStates& solid, AbstractGraph& result, EdgeIndex e) {
    const std::span<const VoxelIndex> path = result.voxel_path(e);
    double length = 0.0;
    double gap = 0.0;
    for (std::size_t k = 1; k < path.size(); ++k) {
        const auto links = graph.of(path[k - 1]);
        const auto at = std::ranges::lower_bound(links, path[k]) - links.begin();
        const double step = graph.length_voxels[graph.first[path[k - 1]] + static_cast<std::size_t>(at)];
        length += step;
        if (solid[path[k - 1]] != SolidState::kSolid || solid[path[k]] != SolidState::kSolid) gap += step;
    }
    result.edges[e].length_voxels = static_cast<float>(length);
    result.edges[e].gap_voxels = static_cast<float>(gap);
}

}  // namespace

AbstractGraph connect_samples(const Adjacency& graph, const SolidStates& solid, std::vector<VoxelIndex> samples,
                              ExtendFrom extend_from, const RunControl& run) {
    check_samples(solid, samples);
    std::vector<std::uint8_t> included(solid.size());
    for (std::size_t v = 0; v < solid.size(); ++v) included[v] = solid[v] == SolidState::kSolid ? 1 : 0;
    ForestGrower grower(graph, std::move(included));
    for (std::size_t i = 0; i < samples.size(); ++i) grower.plant(samples[i], static_cast<std::uint32_t>(i));
    grower.grow();
    run.throw_if_stopped();
    const std::vector<TreeCrossing> solid_crossings =
        shortest_crossings(graph, grower.forest(), solid, CrossingLinks::kSolid);

    grower.extend_to_all(extend_from);
    grower.grow();
    run.throw_if_stopped();
    const std::vector<TreeCrossing> other_crossings =
        shortest_crossings(graph, grower.forest(), solid, CrossingLinks::kNotSolid);

    AbstractGraph result;
    result.samples = std::move(samples);
    result.first_path.push_back(0);
    const auto add = [&](const TreeCrossing& crossing, EdgeState state) {
        result.edges.push_back({crossing.a, crossing.b, state, 0.0f, 0.0f});
        const std::vector<VoxelIndex> path = path_over(grower.forest(), crossing);
        result.path.insert(result.path.end(), path.begin(), path.end());
        result.first_path.push_back(static_cast<std::uint32_t>(result.path.size()));
    };
    // Both lists are sorted by pair; a pair that has a solid edge gets no empty one.
    const auto pair = [](const TreeCrossing& crossing) { return std::pair(crossing.a, crossing.b); };
    auto next_solid = solid_crossings.begin();
    for (const TreeCrossing& crossing : other_crossings) {
        while (next_solid != solid_crossings.end() && pair(*next_solid) < pair(crossing))
            add(*next_solid++, EdgeState::kSolid);
        const bool has_solid_edge = next_solid != solid_crossings.end() && pair(*next_solid) == pair(crossing);
        if (!has_solid_edge) add(crossing, EdgeState::kEmpty);
    }
    while (next_solid != solid_crossings.end()) add(*next_solid++, EdgeState::kSolid);

    parallel_for(result.edges.size(), 256,
                 [&](std::size_t e) { measure_path(graph, solid, result, static_cast<EdgeIndex>(e)); });
    ShortestPathForest forest = grower.take();
    result.owner = std::move(forest.owner);
    for (std::size_t v = 0; v < result.owner.size(); ++v)
        if (forest.distance[v] == kUnreached) result.owner[v] = kNoSample;
    return result;
}

}  // namespace fretwork
