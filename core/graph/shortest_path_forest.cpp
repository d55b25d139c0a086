#include "core/graph/shortest_path_forest.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <tuple>

namespace fretwork {
namespace {

constexpr GraphDistance kNotWaiting = kUnreached;

GraphDistance link_distance(float length_voxels) {
    return std::max<GraphDistance>(1, to_distance(static_cast<double>(length_voxels)));
}

}  // namespace

ForestGrower::ForestGrower(const Adjacency& graph, std::vector<std::uint8_t> included)
    : graph_(&graph), included_(std::move(included)) {
    // Of one link at least; the bits of positive numbers are in the order of the numbers.
    std::uint32_t shortest = std::bit_cast<std::uint32_t>(std::numeric_limits<float>::max());
    std::uint32_t longest = 0;
    for (const float length : graph.length_voxels) {
        shortest = std::min(shortest, std::bit_cast<std::uint32_t>(length));
        longest = std::max(longest, std::bit_cast<std::uint32_t>(length));
    }
    if (longest != 0) width_ = link_distance(std::bit_cast<float>(shortest));
    // A link from bucket k ends in bucket k + longest / width + 1 at most.
    ring_.resize(std::max(kDistanceUnit, link_distance(std::bit_cast<float>(longest))) / width_ + 2);
    clear();
}

void ForestGrower::clear() {
    const std::size_t n = graph_->first.empty() ? 0 : graph_->first.size() - 1;
    assert(included_.empty() || included_.size() == n);
    forest_.distance.assign(n, kUnreached);
    forest_.owner.assign(n, 0);
    forest_.parent.assign(n, kNoVoxel);
    waiting_in_.assign(n, kNotWaiting);
    planted_.clear();
    for (std::vector<VoxelIndex>& waiting : ring_) waiting.clear();
    waiting_ = 0;
}

void ForestGrower::forget(std::span<const VoxelIndex> vertices) {
    for (const VoxelIndex v : vertices) {
        forest_.distance[v] = kUnreached;
        forest_.parent[v] = kNoVoxel;
    }
}

void ForestGrower::plant(VoxelIndex v, std::uint32_t owner, GraphDistance at) {
    assert(included_.empty() || included_[v] != 0);
    if (std::tie(forest_.distance[v], forest_.owner[v]) <= std::tie(at, owner)) return;
    forest_.distance[v] = at;
    forest_.owner[v] = owner;
    forest_.parent[v] = v;
    planted_.push_back(v);
}

void ForestGrower::extend_to_all(ExtendFrom from) {
    const std::size_t n = forest_.distance.size();
    included_.resize(n);
    for (VoxelIndex v = 0; v < n; ++v) included_[v] = forest_.distance[v] == kUnreached ? 1 : 0;
    for (VoxelIndex v = 0; v < n; ++v) {
        if (included_[v] != 0) continue;
        if (from == ExtendFrom::kTree) forest_.distance[v] = 0;
        const auto links = graph_->of(v);
        if (std::ranges::any_of(links, [&](VoxelIndex w) { return included_[w] != 0; })) planted_.push_back(v);
    }
}

void ForestGrower::push(VoxelIndex v, GraphDistance at) {
    if (waiting_in_[v] == bucket(at)) return;
    waiting_in_[v] = bucket(at);
    ring_[bucket(at) % ring_.size()].push_back(v);
    ++waiting_;
}

void ForestGrower::relax_links(VoxelIndex v, GraphDistance limit) {
    const GraphDistance base = forest_.distance[v];
    const std::uint32_t owner = forest_.owner[v];
    for (std::uint32_t e = graph_->first[v]; e < graph_->first[v + 1]; ++e) {
        const VoxelIndex w = graph_->neighbor[e];
        const GraphDistance d = base + link_distance(graph_->length_voxels[e]);
        const GraphDistance old = forest_.distance[w];
        if (d > old || d > limit || (!included_.empty() && included_[w] == 0)) continue;
        if (d == old && std::tie(owner, v) >= std::tie(forest_.owner[w], forest_.parent[w])) continue;
        const bool only_parent = d == old && forest_.owner[w] == owner;
        forest_.distance[w] = d;
        forest_.owner[w] = owner;
        forest_.parent[w] = v;
        if (!only_parent) push(w, d);
    }
}

/// The front is spread over the whole shell, so that nearly every vertex has to be waited for; ask for it early.
void ForestGrower::fetch_ahead(const std::vector<VoxelIndex>& open, std::size_t at) const {
    constexpr std::size_t kFar = 16;
    constexpr std::size_t kNear = 6;
    if (at + kFar < open.size()) {
        __builtin_prefetch(&graph_->first[open[at + kFar]]);
        __builtin_prefetch(&waiting_in_[open[at + kFar]]);
        __builtin_prefetch(&forest_.distance[open[at + kFar]]);
    }
    if (at + kNear < open.size()) {
        const std::uint32_t link = graph_->first[open[at + kNear]];
        __builtin_prefetch(graph_->neighbor.data() + link);
        __builtin_prefetch(graph_->length_voxels.data() + link);
    }
}

void ForestGrower::grow(GraphDistance limit) {
    const auto distance = [&](VoxelIndex v) { return forest_.distance[v]; };
    if (!std::ranges::is_sorted(planted_, {}, distance)) std::ranges::stable_sort(planted_, {}, distance);
    std::size_t next_planted = 0;
    GraphDistance current = 0;
    std::vector<VoxelIndex> open;
    while (waiting_ > 0 || next_planted < planted_.size()) {
        if (waiting_ == 0) current = bucket(forest_.distance[planted_[next_planted]]);
        open.swap(ring_[current % ring_.size()]);
        waiting_ -= open.size();
        for (std::size_t i = 0; i < open.size(); ++i) {
            fetch_ahead(open, i);
            const VoxelIndex v = open[i];
            // Whoever was improved after it came here waited, and was opened, in an earlier bucket.
            if (waiting_in_[v] != current) continue;
            waiting_in_[v] = kNotWaiting;
            relax_links(v, limit);
        }
        for (; next_planted < planted_.size() && bucket(forest_.distance[planted_[next_planted]]) <= current;
             ++next_planted)
            relax_links(planted_[next_planted], limit);
        open.clear();
        ++current;
    }
    planted_.clear();
}

ShortestPathForest shortest_path_forest(const Adjacency& graph, std::span<const VoxelIndex> sources,
                                        std::span<const std::uint8_t> included, GraphDistance limit) {
    ForestGrower grower(graph, {included.begin(), included.end()});
    for (std::size_t i = 0; i < sources.size(); ++i) grower.plant(sources[i], static_cast<std::uint32_t>(i));
    grower.grow(limit);
    return grower.take();
}

std::vector<VoxelIndex> path_to_source(const ShortestPathForest& forest, VoxelIndex v) {
    std::vector<VoxelIndex> path;
    if (forest.parent[v] == kNoVoxel) return path;
    path.push_back(v);
    while (forest.parent[v] != v) {
        v = forest.parent[v];
        path.push_back(v);
    }
    return path;
}

}  // namespace fretwork
