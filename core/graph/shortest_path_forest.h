// Stage 4b: shortest paths from many sources at once, over the surface graph or its solid part.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "core/shell/surface_voxels.h"

namespace fretwork {

/// Path length in fixed point, so that sums are exact and ties are ties. 4096 units are one voxel;
/// the lengths 1, sqrt 2, sqrt 3 are off by less than 1e-4 of themselves.
using GraphDistance = std::uint32_t;
inline constexpr GraphDistance kDistanceUnit = 4096;
inline constexpr GraphDistance kUnreached = std::numeric_limits<GraphDistance>::max();
inline constexpr VoxelIndex kNoVoxel = std::numeric_limits<VoxelIndex>::max();

[[nodiscard]] inline GraphDistance to_distance(double voxels) {
    // Lengths are positive, and this is called for every link: no call into the mathematics library.
    return static_cast<GraphDistance>(voxels * kDistanceUnit + 0.5);  // NOLINT(bugprone-incorrect-roundings)
}
[[nodiscard]] inline double to_voxels(GraphDistance d) {
    return static_cast<double>(d) / kDistanceUnit;
}

/// One tree per source. Structure of arrays over the vertices of the graph.
struct ShortestPathForest {
    std::vector<GraphDistance> distance;  ///< from the nearest source; kUnreached where there is no path
    std::vector<std::uint32_t> owner;     ///< number of that source; undefined where unreached
    std::vector<VoxelIndex> parent;       ///< next vertex towards it; itself at a source, kNoVoxel where unreached
};

/// How far a vertex counts that an extended forest starts from.
enum class ExtendFrom {
    kSource,  ///< its distance from the source: the shortest paths between sources
    kTree,    ///< zero: the shortest gaps between trees
};

/// Dijkstra's algorithm, grown in portions: plant sources, grow, plant more, grow on.
///
/// Ties  a vertex belongs to the least (distance, owner, parent), whatever the order of growth.
/// How   vertices wait in buckets as wide as the shortest link, so that no vertex of a bucket can
///       improve another of the same bucket; every bucket is final when it is opened and no heap is
///       needed.
/// Cost  linear in the links of the vertices whose entry changes.
class ForestGrower {
  public:
    /// \param graph     links of positive length; must outlive the grower
    /// \param included  vertices that may be entered, one byte each; empty means all
    explicit ForestGrower(const Adjacency& graph, std::vector<std::uint8_t> included = {});

    /// Makes `v` a source. Ignored where v already is at no greater (distance, owner).
    void plant(VoxelIndex v, std::uint32_t owner, GraphDistance at = 0);

    /// From now on the trees stay as they are and growth may enter every vertex they have not reached:
    /// extends a forest of G_solid into G_surface. Call grow() next.
    void extend_to_all(ExtendFrom from);

    /// Spreads from everything planted since the last call, not beyond `limit`.
    void grow(GraphDistance limit = kUnreached - 1);

    /// Forgets every source and path. Not after extend_to_all(). Cost: linear.
    void clear();

    /// Forgets what was found about `vertices`: all that can be reached from each other.
    void forget(std::span<const VoxelIndex> vertices);

    [[nodiscard]] const ShortestPathForest& forest() const { return forest_; }
    [[nodiscard]] ShortestPathForest take() { return std::move(forest_); }

  private:
    void push(VoxelIndex v, GraphDistance at);
    void relax_links(VoxelIndex v, GraphDistance limit);
    void fetch_ahead(const std::vector<VoxelIndex>& open, std::size_t at) const;
    [[nodiscard]] GraphDistance bucket(GraphDistance d) const { return d / width_; }

    const Adjacency* graph_;
    std::vector<std::uint8_t> included_;
    GraphDistance width_ = kDistanceUnit;
    ShortestPathForest forest_;
    std::vector<VoxelIndex> planted_;
    std::vector<GraphDistance> waiting_in_;      ///< per vertex the bucket it waits in
    std::vector<std::vector<VoxelIndex>> ring_;  ///< bucket k waits in ring_[k % ring_.size()]
    std::size_t waiting_ = 0;
};

/// Forest from `sources` (owner i = i-th source) over the vertices with `included[v] != 0`, or over
/// all of them when it is empty.
ShortestPathForest shortest_path_forest(const Adjacency& graph, std::span<const VoxelIndex> sources,
                                        std::span<const std::uint8_t> included = {},
                                        GraphDistance limit = kUnreached - 1);

/// Vertices from `v` to its source, both included. Empty where unreached.
std::vector<VoxelIndex> path_to_source(const ShortestPathForest& forest, VoxelIndex v);

}  // namespace fretwork
