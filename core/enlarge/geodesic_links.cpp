#include "core/enlarge/geodesic_links.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 4096;

/// Chord -> arc: a circle through both points whose normals differ by the same angle. It is exact on spheres and
/// cylinders and covers half of what a chord cuts off at a fold.
float link_length(const SurfaceVoxels& shell, VoxelIndex a, VoxelIndex b) {
    const double chord = (shell.points_mm[a] - shell.points_mm[b]).norm() / shell.grid.voxel_mm;
    const double cosine = std::clamp(static_cast<double>(shell.normals[a].dot(shell.normals[b])), -1.0, 1.0);
    const double half_angle = 0.5 * std::acos(cosine);
    const double stretch = half_angle < 1e-3 ? 1.0 : half_angle / std::sin(half_angle);
    return static_cast<float>(chord * stretch);
}

void collect_two_rings(const SurfaceVoxels& shell, VoxelIndex v, std::vector<VoxelIndex>& ring) {
    ring.clear();
    for (const VoxelIndex a : shell.adjacency.of(v)) {
        ring.push_back(a);
        const std::span<const VoxelIndex> beyond = shell.adjacency.of(a);
        ring.insert(ring.end(), beyond.begin(), beyond.end());
    }
    std::sort(ring.begin(), ring.end());
    ring.erase(std::unique(ring.begin(), ring.end()), ring.end());
    std::erase(ring, v);
}

using HeapItem = std::pair<float, VoxelIndex>;

void push(std::vector<HeapItem>& heap, float distance, VoxelIndex v) {
    heap.emplace_back(distance, v);
    std::push_heap(heap.begin(), heap.end(), std::greater<>{});
}

HeapItem pop(std::vector<HeapItem>& heap) {
    std::pop_heap(heap.begin(), heap.end(), std::greater<>{});
    const HeapItem top = heap.back();
    heap.pop_back();
    return top;
}

}  // namespace

GeodesicLinks link_two_rings(const SurfaceVoxels& shell, const RunControl& run) {
    const std::size_t n = shell.size();
    struct Chunk {
        std::vector<VoxelIndex> neighbor;
        std::vector<float> length;
    };
    std::vector<Chunk> chunks((n + kGrain - 1) / kGrain);
    GeodesicLinks links;
    links.first.assign(n + 1, 0);
    parallel_chunks(n, kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        Chunk& chunk = chunks[begin / kGrain];
        std::vector<VoxelIndex> ring;
        for (std::size_t v = begin; v < end; ++v) {
            collect_two_rings(shell, static_cast<VoxelIndex>(v), ring);
            for (const VoxelIndex u : ring) {
                chunk.neighbor.push_back(u);
                chunk.length.push_back(link_length(shell, static_cast<VoxelIndex>(v), u));
            }
            links.first[v + 1] = static_cast<std::uint32_t>(ring.size());
        }
    });
    for (std::size_t v = 0; v < n; ++v) links.first[v + 1] += links.first[v];
    links.neighbor.reserve(links.first[n]);
    links.length_voxels.reserve(links.first[n]);
    for (Chunk& chunk : chunks) {
        links.neighbor.insert(links.neighbor.end(), chunk.neighbor.begin(), chunk.neighbor.end());
        links.length_voxels.insert(links.length_voxels.end(), chunk.length.begin(), chunk.length.end());
        chunk = {};
    }
    return links;
}

std::vector<float> geodesic_distance(const GeodesicLinks& links, const VoxelMask& sources, double reach_voxels,
                                     const RunControl& run) {
    const auto reach = static_cast<float>(reach_voxels);
    std::vector<float> distance(links.size(), kBeyondReach);
    std::vector<HeapItem> heap;
    for (std::size_t v = 0; v < distance.size(); ++v)
        if (sources[v] != 0) distance[v] = 0.0F;
    // Sources surrounded by sources reach nobody first; only those with a neighbour outside start the front.
    for (std::size_t v = 0; v < distance.size(); ++v) {
        if (sources[v] == 0) continue;
        for (std::uint32_t k = links.first[v]; k < links.first[v + 1]; ++k) {
            if (sources[links.neighbor[k]] != 0) continue;
            heap.emplace_back(0.0F, static_cast<VoxelIndex>(v));
            break;
        }
    }
    std::make_heap(heap.begin(), heap.end(), std::greater<>{});
    std::size_t steps = 0;
    while (!heap.empty()) {
        if ((++steps & 0x3FFF) == 0) run.throw_if_stopped();
        const auto [d, v] = pop(heap);
        if (d > distance[v]) continue;
        for (std::uint32_t k = links.first[v]; k < links.first[v + 1]; ++k) {
            const float next = d + links.length_voxels[k];
            if (next > reach || next >= distance[links.neighbor[k]]) continue;
            distance[links.neighbor[k]] = next;
            push(heap, next, links.neighbor[k]);
        }
    }
    return distance;
}

GeodesicDisc::GeodesicDisc(const GeodesicLinks& links) : links_(&links), distance_(links.size(), kBeyondReach) {}

void GeodesicDisc::collect(VoxelIndex center, double reach_voxels) {
    const auto reach = static_cast<float>(reach_voxels);
    reached_.clear();
    touched_.assign(1, center);
    distance_[center] = 0.0F;
    push(heap_, 0.0F, center);
    while (!heap_.empty()) {
        const auto [d, v] = pop(heap_);
        if (d > distance_[v]) continue;
        reached_.push_back({v, d});
        for (std::uint32_t k = links_->first[v]; k < links_->first[v + 1]; ++k) {
            const VoxelIndex u = links_->neighbor[k];
            const float next = d + links_->length_voxels[k];
            if (next > reach || next >= distance_[u]) continue;
            if (distance_[u] == kBeyondReach) touched_.push_back(u);
            distance_[u] = next;
            push(heap_, next, u);
        }
    }
    for (const VoxelIndex v : touched_) distance_[v] = kBeyondReach;
}

}  // namespace fretwork
