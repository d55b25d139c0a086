#include "core/enlarge/geodesic_links.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <functional>
#include <utility>

#include "core/base/parallel.h"

namespace fretwork {
namespace {

constexpr std::size_t kGrain = 1024;

/// Chord -> arc: a circle through both points whose normals differ by the same angle. It is exact on spheres and
/// cylinders and covers half of what a chord cuts off at a fold.
float link_length(const SurfaceVoxels& shell, VoxelIndex a, VoxelIndex b) {
    const double chord = (shell.points_mm[a] - shell.points_mm[b]).norm() / shell.grid.voxel_mm;
    const double cosine = std::clamp(static_cast<double>(shell.normals[a].dot(shell.normals[b])), -1.0, 1.0);
    const double half_angle = 0.5 * std::acos(cosine);
    const double stretch = half_angle < 1e-3 ? 1.0 : half_angle / std::sin(half_angle);
    return static_cast<float>(chord * stretch);
}

/// Lists the voxels up to two links away. They lie in the 5x5x5 cells around, whose order is that of the voxels; where
/// cells hold several, the list is sorted.
class TwoRings {
  public:
    explicit TwoRings(const SurfaceVoxels& shell) : shell_(shell) {}

    /// Ascending; valid until the next call.
    const std::vector<VoxelIndex>& around(VoxelIndex v) {
        ring_.clear();
        if (!mark_cells(v)) {
            sort_all(v);
            return ring_;
        }
        for (std::size_t word = 0; word < 2; ++word)
            for (std::uint64_t left = marked_[word]; left != 0; left &= left - 1)
                ring_.push_back(voxel_[64 * word + static_cast<std::size_t>(std::countr_zero(left))]);
        return ring_;
    }

  private:
    /// \return false where a cell holds several voxels
    bool mark_cells(VoxelIndex v) {
        marked_ = {0, 0};
        bool single = true;
        const VoxelCoord& c = shell_.coords[v];
        const auto mark = [&](VoxelIndex w) {
            if (w == v) return;
            const VoxelCoord& d = shell_.coords[w];
            const int code = (d[0] - c[0] + 2) + 5 * (d[1] - c[1] + 2) + 25 * (d[2] - c[2] + 2);
            const auto cell = static_cast<std::size_t>(code);
            const std::uint64_t bit = std::uint64_t{1} << cell % 64;
            single = single && ((marked_[cell / 64] & bit) == 0 || voxel_[cell] == w);
            marked_[cell / 64] |= bit;
            voxel_[cell] = w;
        };
        for (const VoxelIndex a : shell_.adjacency.of(v)) {
            mark(a);
            for (const VoxelIndex b : shell_.adjacency.of(a)) mark(b);
        }
        return single;
    }

    void sort_all(VoxelIndex v) {
        for (const VoxelIndex a : shell_.adjacency.of(v)) {
            ring_.push_back(a);
            const std::span<const VoxelIndex> beyond = shell_.adjacency.of(a);
            ring_.insert(ring_.end(), beyond.begin(), beyond.end());
        }
        std::sort(ring_.begin(), ring_.end());
        ring_.erase(std::unique(ring_.begin(), ring_.end()), ring_.end());
        std::erase(ring_, v);
    }

    const SurfaceVoxels& shell_;
    std::vector<VoxelIndex> ring_;
    std::array<std::uint64_t, 2> marked_{};
    std::array<VoxelIndex, 125> voxel_{};  ///< of the marked cells
};

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

// Grows distances outward from a set, all voxels of a range of distances at once. What comes out is the least sum of
// lengths over all paths, which no order of the steps changes: sums of floats grow with each of their terms.
class DistanceFront {
  public:
    DistanceFront(const GeodesicLinks& links, const VoxelMask& sources, float reach, const RunControl& run)
        : links_(links), reach_(reach), run_(run), distance_(links.size(), kBeyondReach), ranges_(range_of(reach) + 1) {
        // Sources surrounded by sources reach nobody first; only those with a neighbour outside start the front.
        for_chunks(links.size(), [&](std::size_t v, std::vector<Reached>& reached) {
            if (sources[v] == 0) return;
            distance_[v] = 0.0F;
            const auto begin = links.neighbor.begin() + links.first[v],
                       end = links.neighbor.begin() + links.first[v + 1];
            if (std::any_of(begin, end, [&](VoxelIndex u) { return sources[u] == 0; }))
                reached.push_back({static_cast<VoxelIndex>(v), 0});
        });
    }

    std::vector<float> run() {
        // A short link may lead to another voxel of the same range, hence the inner loop.
        for (std::size_t range = 0; range < ranges_.size(); ++range)
            while (!ranges_[range].empty()) {
                run_.throw_if_stopped();
                const std::vector<VoxelIndex> front = std::exchange(ranges_[range], {});
                for_chunks(front.size(),
                           [&](std::size_t i, std::vector<Reached>& reached) { step_from(front[i], range, reached); });
            }
        return std::move(distance_);
    }

  private:
    struct Reached {
        VoxelIndex voxel;
        std::uint32_t range;
    };

    /// Hardly any link is shorter than a range is wide.
    [[nodiscard]] static std::uint32_t range_of(float distance) { return static_cast<std::uint32_t>(2.0F * distance); }

    [[nodiscard]] float distance(VoxelIndex v) {
        return std::atomic_ref<float>(distance_[v]).load(std::memory_order_relaxed);
    }

    void step_from(VoxelIndex v, std::size_t range, std::vector<Reached>& reached) {
        const float d = distance(v);
        if (range_of(d) < range) return;  // it came closer since and was done then
        for (std::uint32_t k = links_.first[v]; k < links_.first[v + 1]; ++k) {
            const VoxelIndex u = links_.neighbor[k];
            const float next = d + links_.length_voxels[k];
            if (next <= reach_ && lower(u, next)) reached.push_back({u, range_of(next)});
        }
    }

    bool lower(VoxelIndex v, float to) {
        std::atomic_ref<float> held(distance_[v]);
        float now = held.load(std::memory_order_relaxed);
        while (to < now)
            if (held.compare_exchange_weak(now, to, std::memory_order_relaxed)) return true;
        return false;
    }

    template <class Body>
    void for_chunks(std::size_t count, const Body& body) {
        constexpr std::size_t grain = 512;
        std::vector<std::vector<Reached>> chunks((count + grain - 1) / grain);
        parallel_chunks(count, grain, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) body(i, chunks[begin / grain]);
        });
        for (const std::vector<Reached>& chunk : chunks)
            for (const Reached& r : chunk) ranges_[r.range].push_back(r.voxel);
    }

    const GeodesicLinks& links_;
    float reach_;
    const RunControl& run_;
    std::vector<float> distance_;
    std::vector<std::vector<VoxelIndex>> ranges_;  ///< voxels of the front by distance
};

}  // namespace

GeodesicLinks link_two_rings(const SurfaceVoxels& shell, const RunControl& run) {
    const std::size_t n = shell.size();
    std::vector<std::vector<VoxelIndex>> chunks((n + kGrain - 1) / kGrain);
    GeodesicLinks links;
    links.first.assign(n + 1, 0);
    parallel_chunks(n, kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::vector<VoxelIndex>& chunk = chunks[begin / kGrain];
        chunk.reserve(44 * (end - begin));
        TwoRings rings(shell);
        for (std::size_t v = begin; v < end; ++v) {
            const std::vector<VoxelIndex>& ring = rings.around(static_cast<VoxelIndex>(v));
            chunk.insert(chunk.end(), ring.begin(), ring.end());
            links.first[v + 1] = static_cast<std::uint32_t>(ring.size());
        }
    });
    for (std::size_t v = 0; v < n; ++v) links.first[v + 1] += links.first[v];
    links.neighbor.resize(links.first[n]);
    links.length_voxels.resize(links.first[n]);
    parallel_chunks(n, kGrain, [&](std::size_t begin, std::size_t end) {
        run.throw_if_stopped();
        std::vector<VoxelIndex>& chunk = chunks[begin / kGrain];
        std::copy(chunk.begin(), chunk.end(), links.neighbor.begin() + links.first[begin]);
        chunk = {};
        for (std::size_t v = begin; v < end; ++v)
            for (std::uint32_t k = links.first[v]; k < links.first[v + 1]; ++k)
                links.length_voxels[k] = link_length(shell, static_cast<VoxelIndex>(v), links.neighbor[k]);
    });
    return links;
}

std::vector<float> geodesic_distance(const GeodesicLinks& links, const VoxelMask& sources, double reach_voxels,
                                     const RunControl& run) {
    return DistanceFront(links, sources, static_cast<float>(reach_voxels), run).run();
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
